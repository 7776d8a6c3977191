#include "runs/exports/export_runs.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "runs/exports/sheet_units.h"
#include "runs/exports/write_export.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::exports {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ExportRunsTest : public log::LogTest {
 protected:
  std::vector<ExportedRun> Read(const std::vector<std::string>& files, const Selection& selection) {
    said_.clear();
    return ReadRuns(files, {}, selection, false, [&](const std::string& line) { said_.push_back(line); });
  }
  std::string Write(const std::string& name, const runs::RunMessages& run) {
    log::WriteRun(Path(name), run, "");
    return Path(name);
  }
  std::vector<std::string> said_;
};

Selection Channels(std::vector<std::string> names) {
  Selection selection;
  selection.channels = std::move(names);
  return selection;
}

const Sheet& SheetOf(const ExportedRun& run, const std::string& name) {
  return *std::find_if(run.sheets.begin(), run.sheets.end(),
                       [&](const Sheet& sheet) { return sheet.name == name; });
}

std::vector<int64_t> Ticks(const Sheet& sheet) {
  const auto column = std::find_if(sheet.columns.begin(), sheet.columns.end(),
                                   [](const SheetColumn& one) { return one.field.name == "tick"; });
  if (const auto* const whole = std::get_if<std::vector<int64_t>>(&column->values)) return *whole;
  const auto& numbers = std::get<std::vector<double>>(column->values);
  return {numbers.begin(), numbers.end()};
}

runs::RunMessages Part(int first, int last, int64_t session) {
  runs::RunMessages run = log::SampleRun(last + 1);
  auto& states = run.Of<state_t>();
  states.erase(states.begin(), states.begin() + first);
  for (state_t& state : states) state.session = session;
  return run;
}

// Tests that without channels the run's table is exported, and with them their messages; each row has the
// plant time of its tick.
TEST_F(ExportRunsTest, TableAndChannels) {
  const std::string file = Write("run.lcmlog", log::SampleRun(7));
  const auto table = Read({file}, {});
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].name, "run");
  ASSERT_EQ(table[0].sheets.size(), 1u);
  EXPECT_THAT(Ticks(table[0].sheets[0]), ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(said_, IsEmpty());
  const auto channels = Read({file}, Channels({"HYDRO_PRESSURE_COMMAND", "HYDRO_STATE", "HYDRO_STATE"}));
  ASSERT_EQ(channels[0].sheets.size(), 2u);
  const Sheet& commands = SheetOf(channels[0], "HYDRO_PRESSURE_COMMAND");
  EXPECT_THAT(Ticks(commands), ElementsAre(0, 5));
  EXPECT_THAT(commands.time_s, ElementsAre(0, 1e-3 * 5));
  EXPECT_EQ(commands.columns[4].field.unit, "psi");
}

// Tests the window, which is closed, and the rate, which thins what has a row for every tick or sample.
TEST_F(ExportRunsTest, WindowAndRate) {
  const std::string file = Write("run.lcmlog", log::SampleRun(100));
  Selection selection;
  selection.from_s = 0.01;
  selection.to_s = 0.012;
  EXPECT_THAT(Ticks(Read({file}, selection)[0].sheets[0]), ElementsAre(10, 11, 12));
  selection.to_s = 0.05;
  selection.rate_hz = 100;
  EXPECT_THAT(Ticks(Read({file}, selection)[0].sheets[0]), ElementsAre(10, 20, 30, 40, 50));
  selection.rate_hz = 1e9;
  EXPECT_EQ(Read({file}, selection)[0].sheets[0].rows(), 41u);
  selection.from_s = 5;
  selection.to_s = 6;
  EXPECT_THAT(log::InputErrorOf([&] { Read({file}, selection); }),
              HasSubstr("--from, --to: found nothing of " + file +
                        " there, allowed is a window of its run, 0 s to 0.099 s"));
}

// Tests that faults are never thinned out.
TEST_F(ExportRunsTest, FaultsStay) {
  runs::RunMessages run = log::SampleRun(20);
  for (int i = 0; i < 5; ++i) {
    fault_t fault{};
    fault.tick = 10;
    fault.sequence = i;
    fault.value = fault.limit = std::nan("");
    run.Of<fault_t>().push_back(fault);
  }
  const size_t faults = run.Of<fault_t>().size();
  Selection selection = Channels({"HYDRO_FAULT", "HYDRO_STATE"});
  selection.rate_hz = 100;
  const auto runs = Read({Write("run.lcmlog", run)}, selection);
  EXPECT_EQ(SheetOf(runs[0], "HYDRO_FAULT").rows(), faults);
  EXPECT_EQ(SheetOf(runs[0], "HYDRO_STATE").rows(), 2u);
}

// Tests that logs whose ticks go on are one run, and others runs of their own, with names of their own.
TEST_F(ExportRunsTest, SeveralLogs) {
  const std::string first = Write("run.lcmlog", Part(0, 4, 7)),
                    second = Write("run-001.lcmlog", Part(5, 9, 7));
  const std::string other = Write("other.lcmlog", Part(5, 9, 8));
  std::filesystem::create_directory(Path("sub"));
  const std::string again = Write("sub/run.lcmlog", Part(0, 2, 7));
  const auto runs = Read({first, second, other, again}, {});
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_THAT(runs[0].files, ElementsAre(first, second));
  EXPECT_THAT(Ticks(runs[0].sheets[0]), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_EQ(runs[1].name, "other");
  EXPECT_EQ(runs[2].name, "run_2");
}

// Tests that a log of two plants has no table, which --all-channels says, and that their messages keep their
// own times.
TEST_F(ExportRunsTest, SeveralSessions) {
  runs::RunMessages run = Part(0, 4, 7);
  const runs::RunMessages next = Part(0, 3, 8);
  for (const state_t& state : next.Of<state_t>()) {
    run.Of<state_t>().push_back(state);
    run.Of<state_t>().back().time += 100;
  }
  const std::string file = Write("run.lcmlog", run);
  EXPECT_THAT(log::InputErrorOf([&] { Read({file}, {}); }), HasSubstr("one run by one sender is needed"));
  Selection all;
  all.all = true;
  const auto runs = Read({file}, all);
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_THAT(said_[0], HasSubstr("exported without the run's table"));
  EXPECT_EQ(SheetOf(runs[0], "HYDRO_STATE").rows(), 9u);
}

// Tests that a log without this stack's messages, a damaged one and wrong choices are errors that say what is
// allowed.
TEST_F(ExportRunsTest, WrongInput) {
  const std::string file = Write("run.lcmlog", log::SampleRun(7));
  const auto error = [&](const Selection& selection) {
    return log::InputErrorOf([&] { Read({file}, selection); });
  };
  EXPECT_THAT(error(Channels({"HYDRO_STAT"})),
              HasSubstr("--channel: found \"HYDRO_STAT\", did you mean \"HYDRO_STATE\"?, allowed of " + file +
                        " are \"table\""));
  EXPECT_THAT(error(Channels({"HYDRO_REARM"})), HasSubstr("found \"HYDRO_REARM\""));
  Selection backwards;
  backwards.from_s = 2;
  backwards.to_s = 1;
  EXPECT_THAT(error(backwards), HasSubstr("--to: found 1 s, allowed is a time from --from, 2 s, on"));
  Selection rate;
  rate.rate_hz = -1;
  EXPECT_THAT(error(rate), HasSubstr("--rate: found -1"));

  log::WriteEvents(Path("foreign"), {{"CAMERA", "abc", 5}});
  EXPECT_THAT(log::InputErrorOf([&] { Read({Path("foreign")}, {}); }),
              HasSubstr("found no message on HYDRO_STATE"));
  Selection all;
  all.all = true;
  EXPECT_THAT(log::InputErrorOf([&] { Read({Path("foreign")}, all); }),
              HasSubstr("found no message of this stack"));

  std::string bytes = log::ReadBytes(file);
  bytes[bytes.size() / 2] ^= 1;
  log::WriteBytes(Path("damaged"), bytes);
  EXPECT_THAT(log::InputErrorOf([&] { Read({Path("damaged")}, all); }), HasSubstr("hydro-log repair"));
}

// Tests --si: the values, the units, and in the table the names.
TEST_F(ExportRunsTest, Si) {
  const std::string file = Write("run.lcmlog", log::SampleRun(3));
  Selection selection = Channels({"table", "HYDRO_STATE"});
  const auto psi = Read({file}, selection);
  selection.si = true;
  const auto si = Read({file}, selection);
  const SheetColumn &before = psi[0].sheets[0].columns[9], &after = si[0].sheets[0].columns[9];
  EXPECT_EQ(before.field.name, "p1_psi");
  EXPECT_EQ(after.field.name, "p1_Pa");
  EXPECT_EQ(after.field.unit, "Pa");
  EXPECT_DOUBLE_EQ(std::get<std::vector<double>>(after.values)[1],
                   std::get<std::vector<double>>(before.values)[1] * 6.894757293168361e3);
  EXPECT_EQ(SheetOf(si[0], "HYDRO_STATE").columns[9].field.unit, "Pa");
  EXPECT_EQ(si[0].sheets[0].columns[6].field.name, "motor_speed_rad_s");
}

// Tests the units of a rig in SI: what the values are in, and that --si has nothing to do.
TEST(SheetUnitsTest, ModelInSi) {
  Sheet sheet;
  sheet.is_table = true;
  sheet.columns = {{{"p1_psi", definitions::FieldType::kDouble, "", "psi", ""}, std::vector<double>{2e6}}};
  Sheet si = sheet;
  SetUnits(kSiUnits, false, &sheet);
  EXPECT_EQ(sheet.columns[0].field.unit, "Pa");
  EXPECT_EQ(sheet.columns[0].field.name, "p1_Pa") << "a column's name says what it holds";
  SetUnits(kSiUnits, true, &si);
  EXPECT_EQ(si.columns[0].field.name, "p1_Pa");
  EXPECT_EQ(std::get<std::vector<double>>(si.columns[0].values)[0], 2e6);
}

// Tests which format a name tells, and what is refused.
TEST(FormatTest, FromName) {
  EXPECT_EQ(FormatFor("a.CSV", std::nullopt), Format::kCsv);
  EXPECT_EQ(FormatFor("a.mat", std::nullopt), Format::kMat);
  EXPECT_EQ(FormatFor("a.mat", "mat73"), Format::kMat73);
  EXPECT_EQ(FormatFor("a.hdf5", std::nullopt), Format::kHdf5);
  EXPECT_EQ(FormatFor("a.mcap", std::nullopt), Format::kMcap);
  EXPECT_EQ(FormatFor("-", std::nullopt), Format::kCsv);
  EXPECT_EQ(FormatFor("-", "mcap"), Format::kMcap);
  EXPECT_EQ(FormatFor("tables/", std::nullopt), Format::kCsv);
  EXPECT_THAT(log::InputErrorOf([] { FormatFor("tables/", "hdf5"); }),
              HasSubstr("tables/: found a folder with --format hdf5, allowed is one for csv"));
  EXPECT_EQ(FormatFor("/dev/null", "hdf5"), Format::kHdf5);
  EXPECT_THAT(log::InputErrorOf([] { FormatFor("a.txt", std::nullopt); }),
              HasSubstr("a.txt: found a name that tells no format"));
  EXPECT_THAT(log::InputErrorOf([] { FormatFor("a.csv", "mat"); }),
              HasSubstr("a.csv: found an ending of csv with --format mat"));
  EXPECT_THAT(log::InputErrorOf([] { FormatFor("a", "mcaps"); }),
              HasSubstr("--format: found \"mcaps\", did you mean \"mcap\"?"));
}

}  // namespace
}  // namespace hydro::exports
