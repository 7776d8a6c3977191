#include "runs/measured/measured_run.h"

#include <gmock/gmock.h>

#include <cmath>

#include "runs/recorded/run_table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

constexpr char kTable[] = R"(t,amps,rpm,"p low",p high,angle
0,1.5,0,100,101,0
0.5,,60,nan,102,1
0.75,2,120,103,,2
)";

constexpr char kSidecar[] = R"(name = "bench, clamped"
shaft = "clamped"
arm_angle_rad = 0.25
[columns]
time = "t"
voltage = { column = "amps", scale = 2.0, offset = 0.5 }
motor_speed = { column = "rpm", scale = 0.10471975512 }
p1 = "p low"
p2 = { column = "p high", offset = 14.7 }
[noise]
p1 = 1.5
)";

class MeasuredRunTest : public log::LogTest {
 protected:
  MeasuredRun Read(const std::string& sidecar = kSidecar, const std::string& table = kTable) {
    log::WriteBytes(Path("run.csv"), table);
    log::WriteBytes(Path("run.toml"), sidecar);
    return ReadMeasuredRun(Path("run.csv"));
  }
  std::string ErrorOf(const std::string& sidecar, const std::string& table = kTable) {
    const std::string error = log::InputErrorOf([&] { Read(sidecar, table); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }
};

// A copy of `text` with `from` replaced by `to`.
std::string With(const std::string& from, const std::string& to, std::string text = kSidecar) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Tests a column that was recorded late: it is read at the time it belongs to, at the nearest sample, and the
// ends without a reading are cut off; errors still name the file's line.
TEST_F(MeasuredRunTest, Delay) {
  const std::string table =
      "t,amps,rpm,p low,p high,angle\n0,1,0,10,20,0\n1,2,1,11,21,0\n2,3,2,12,22,0\n3,4,3,13,23,0\n";
  const MeasuredRun run =
      Read(With("p1 = \"p low\"", "p1 = { column = \"p low\", delay = 0.9 }",
                With("scale = 2.0, offset = 0.5", "delay = -1", With("scale = 0.10471975512", "scale = 1"))),
           table);
  EXPECT_THAT(run.time, ElementsAre(1, 2));
  EXPECT_THAT(run.voltage.values, ElementsAre(1, 2));
  EXPECT_THAT(run.written_commands, ElementsAre()) << "every row has one";
  EXPECT_THAT(run.motor_speed.values, ElementsAre(1, 2));
  EXPECT_THAT(run.p1.values, ElementsAre(12, 13));
  EXPECT_THAT(run.Place(0), HasSubstr("line 3"));
  EXPECT_THAT(ErrorOf(With("p1 = \"p low\"", "p1 = { column = \"p low\", delay = 3 }"), table),
              HasSubstr("delays that leave fewer than two samples"));
  EXPECT_THAT(ErrorOf(With("time = \"t\"", "time = { column = \"t\", delay = 1 }"), table),
              HasSubstr("delay"));
}

// Tests that a table is read as its sidecar says: names, scale and offset, missing values, the held command,
// noise.
TEST_F(MeasuredRunTest, TableWithSidecar) {
  const MeasuredRun run = Read();
  EXPECT_EQ(run.name, "bench, clamped");
  EXPECT_EQ(run.file, Path("run.csv"));
  EXPECT_EQ(run.shaft, model::Shaft::kClamped);
  EXPECT_EQ(run.arm_angle_rad, 0.25);
  EXPECT_FALSE(run.bypass);
  EXPECT_EQ(run.model_text, "");
  EXPECT_THAT(run.time, ElementsAre(0, 0.5, 0.75));
  EXPECT_THAT(run.voltage.values, ElementsAre(3.5, 3.5, 4.5));
  EXPECT_THAT(run.written_commands, ElementsAre(3.5, IsNan(), 4.5));
  EXPECT_THAT(run.motor_speed.values, ElementsAre(0, 60 * 0.10471975512, 120 * 0.10471975512));
  EXPECT_THAT(run.p1.values, ElementsAre(100, IsNan(), 103));
  EXPECT_THAT(run.p2.values, ElementsAre(101 + 14.7, 102 + 14.7, IsNan()));
  for (const MeasuredSignal* absent : {&run.pressure_ref, &run.motor_angle, &run.arm_angle, &run.arm_speed}) {
    EXPECT_FALSE(absent->measured());
  }
  EXPECT_EQ(run.p1.noise, 1.5);
  EXPECT_EQ(run.p2.noise, std::nullopt);
  EXPECT_EQ(run.time_source.column, "t");
  EXPECT_EQ(run.voltage.source.column, "amps");
  EXPECT_EQ(run.voltage.source.scale, 2);
  EXPECT_EQ(run.voltage.source.offset, 0.5);
  EXPECT_EQ(run.p1.source.column, "p low");
  EXPECT_EQ(run.p1.source.scale, 1);
  EXPECT_EQ(run.Place(1), Path("run.csv") + ": line 3");
}

// Tests that only shaft, time and voltage are required, and the defaults of the rest.
TEST_F(MeasuredRunTest, LeastSidecar) {
  const MeasuredRun run =
      Read("shaft = \"free\"\nbypass = true\n[columns]\ntime = \"t\"\nvoltage = \"amps\"\n");
  EXPECT_EQ(run.name, "run");
  EXPECT_EQ(run.shaft, model::Shaft::kFree);
  EXPECT_TRUE(run.bypass);
  EXPECT_FALSE(run.p1.measured());
}

// Tests that a MAT file has a sidecar like a CSV.
TEST_F(MeasuredRunTest, MatWithSidecar) {
  tables::Table table;
  table.columns = {{"t", {0, 1}}, {"amps", {2, 3}}};
  tables::WriteTable(table, Path("bench.mat"));
  log::WriteBytes(Path("bench.toml"), "shaft = \"free\"\n[columns]\ntime = \"t\"\nvoltage = \"amps\"\n");
  const MeasuredRun run = ReadMeasuredRun(Path("bench.mat"));
  EXPECT_EQ(run.name, "bench");
  EXPECT_THAT(run.voltage.values, ElementsAre(2, 3));
  EXPECT_EQ(run.Place(1), Path("bench.mat") + ": row 2");
}

// Tests each way in which a sidecar can be wrong: the message has its line, the key, what was found and what
// is allowed.
TEST_F(MeasuredRunTest, SidecarErrors) {
  const std::string file = Path("run.toml");
  const std::string names = "\"t\", \"amps\", \"rpm\", \"p low\", \"p high\" or \"angle\"";
  EXPECT_THAT(ErrorOf(With("shaft = \"clamped\"", "")),
              AllOf(HasSubstr(file + ": shaft: found nothing"), HasSubstr("\"driven\"")));
  EXPECT_THAT(ErrorOf(With("\"clamped\"\n", "\"bent\"\n")),
              AllOf(HasSubstr(file + ":2: shaft: found \"bent\""), HasSubstr("\"clamped\", \"free\" or")));
  EXPECT_THAT(
      ErrorOf(With("name = ", "nmae = ")),
      AllOf(HasSubstr(file + ":1: \"nmae\": found an unknown key"), HasSubstr("did you mean \"name\"")));
  EXPECT_THAT(ErrorOf(With("time = \"t\"", "")),
              AllOf(HasSubstr("columns.time: found nothing"), HasSubstr(names)));
  EXPECT_THAT(ErrorOf(With("voltage = { column = \"amps\", scale = 2.0, offset = 0.5 }", "")),
              AllOf(HasSubstr(file + ":4: columns.voltage: found nothing"), HasSubstr(names)));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\n"), HasSubstr(file + ": columns.time: found nothing"));
  EXPECT_THAT(ErrorOf(With("motor_speed = ", "motor_sped = ")),
              AllOf(HasSubstr(file + ":7: columns: \"motor_sped\": found an unknown key"),
                    HasSubstr("did you mean \"motor_speed\"")));
  EXPECT_THAT(ErrorOf(With("\"p low\"", "\"p lo\"")),
              AllOf(HasSubstr(file + ":8: columns.p1: found \"p lo\""), HasSubstr(names),
                    HasSubstr("did you mean \"p low\"")));
  EXPECT_THAT(ErrorOf(With("scale = 2.0", "scale = 0.0")),
              AllOf(HasSubstr("columns.voltage.scale: found 0"), HasSubstr("other than 0")));
  EXPECT_THAT(ErrorOf(With("scale = 2.0", "factor = 2.0")),
              HasSubstr("columns.voltage: \"factor\": found an unknown key"));
  EXPECT_THAT(ErrorOf(With("{ column = \"amps\", scale = 2.0, offset = 0.5 }", "{ scale = 2.0 }")),
              HasSubstr("columns.voltage.column: found nothing"));
  EXPECT_THAT(ErrorOf(With("\"p low\"", "7")),
              AllOf(HasSubstr("columns.p1: found 7"), HasSubstr("{ column = \"...\", scale")));
  EXPECT_THAT(ErrorOf(With("p1 = 1.5", "p1 = 0")),
              AllOf(HasSubstr(file + ":11: noise.p1: found 0"), HasSubstr("above 0")));
  EXPECT_THAT(ErrorOf(With("p1 = 1.5", "arm_speed = 1.5")),
              AllOf(HasSubstr("noise.arm_speed: found the noise of a signal that has no column")));
  EXPECT_THAT(ErrorOf(With("p1 = 1.5", "time = 1.5")), HasSubstr("noise: \"time\": found an unknown key"));
  EXPECT_THAT(ErrorOf(With("\"clamped\"", "\"free\"")),
              AllOf(HasSubstr(file + ":3: arm_angle_rad"), HasSubstr("not clamped")));
  EXPECT_THAT(ErrorOf(With("arm_angle_rad = 0.25", "", With("\"clamped\"", "\"driven\""))),
              HasSubstr("shaft: found \"driven\" without columns.arm_angle"));
  EXPECT_THAT(ErrorOf(With("[columns]", "[columns")), HasSubstr(file + ":4: syntax"));
}

// Tests each way in which a table can be wrong: the message has its line and column.
TEST_F(MeasuredRunTest, TableErrors) {
  const std::string file = Path("run.csv");
  EXPECT_THAT(ErrorOf(kSidecar, With("0.75,2", "0.5,2", kTable)),
              AllOf(HasSubstr(file + ": line 4, column t: found 0.5 s"), HasSubstr("above 0.5 s")));
  EXPECT_THAT(ErrorOf(kSidecar, With("0.75,2", "nan,2", kTable)),
              HasSubstr(file + ": line 4, column t: found no value, allowed a time above 0.5 s"));
  EXPECT_THAT(ErrorOf(kSidecar, With("0,1.5", ",1.5", kTable)),
              HasSubstr(file + ": line 2, column t: found no value, allowed a time"));
  EXPECT_THAT(ErrorOf(kSidecar, With("0,1.5,", "0,,", kTable)),
              AllOf(HasSubstr(file + ": line 2, column amps: found no voltage in the first row")));
  EXPECT_THAT(ErrorOf(kSidecar, With("60", "inf", kTable)),
              HasSubstr(file + ": line 3, column rpm: found an infinite value"));
  EXPECT_THAT(ErrorOf(kSidecar, With("60", "sixty", kTable)),
              HasSubstr(file + ": line 3, column rpm: found"));
  EXPECT_THAT(ErrorOf(kSidecar, "t,amps,rpm,p low,p high\n0,1,2,3,4\n"),
              HasSubstr(file + ": line 2, column t: found one row, allowed two or more"));
  EXPECT_THAT(ErrorOf(kSidecar, "t,amps,rpm,p low,p high\n0,1,2,,4\n1,1,2,,4\n"),
              AllOf(HasSubstr(Path("run.toml") + ":8: columns.p1: found \"p low\", which holds no value"),
                    HasSubstr("leave p1 out")));
}

// Tests that a missing table, a missing sidecar and a sidecar in the run's place are named.
TEST_F(MeasuredRunTest, MissingFiles) {
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("none.csv")); }),
              HasSubstr(Path("none.csv") + ": cannot be read"));
  log::WriteBytes(Path("alone.csv"), kTable);
  EXPECT_THAT(
      log::InputErrorOf([&] { ReadMeasuredRun(Path("alone.csv")); }),
      AllOf(HasSubstr(Path("alone.csv") + ": found no " + Path("alone.toml")), HasSubstr("[columns]")));
  log::WriteBytes(Path("alone.toml"), kSidecar);
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("alone.toml")); }), HasSubstr("found a sidecar"));
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("none.lcmlog")); }),
              HasSubstr(Path("none.lcmlog")));
}

// Tests that a log is read with the shaft, the bypass, the noise and the model of its own description, and
// the signals of its export.
TEST_F(MeasuredRunTest, Log) {
  log::WriteRun(Path("a.lcmlog"), log::SampleRun(7), "",
                "[model]\nfile = \"x.toml\"\nshaft = \"clamped\"\narm_angle_rad = 0.3\nbypass = true\n"
                "[noise]\np1_psi = 3\np1_resolution_psi = 12\nmotor_angle_resolution_rad = 1\n");
  const MeasuredRun run = ReadMeasuredRun(Path("a.lcmlog"));
  const tables::Table table = ExportRun(ReadRunLog(Path("a.lcmlog")));
  EXPECT_EQ(run.name, "a");
  EXPECT_EQ(run.shaft, model::Shaft::kClamped);
  EXPECT_EQ(run.arm_angle_rad, 0.3);
  EXPECT_TRUE(run.bypass);
  EXPECT_EQ(run.model_text, "name = \"Table 1\"\n");
  EXPECT_EQ(run.time, table.Find("time_s")->values);
  EXPECT_EQ(run.voltage.values, table.Find("voltage_V")->values);
  EXPECT_EQ(run.motor_angle.values, table.Find("motor_angle_rad")->values);
  EXPECT_EQ(run.arm_speed.values, table.Find("arm_speed_rad_s")->values);
  EXPECT_EQ(run.p2.values, table.Find("p2_psi")->values);
  EXPECT_DOUBLE_EQ(run.p1.noise.value(), std::sqrt(9 + 12.0));
  EXPECT_DOUBLE_EQ(run.motor_angle.noise.value(), std::sqrt(1 / 12.0));
  EXPECT_EQ(run.p2.noise, std::nullopt);
  EXPECT_EQ(NameWithCaution(run), "\"a\"");
}

// Tests that results from a log that ends early name that beside the run.
TEST_F(MeasuredRunTest, LogWithoutItsEnd) {
  log::WriteRun(Path("a.lcmlog"), log::SampleRun(7), "",
                "[model]\nshaft = \"clamped\"\narm_angle_rad = 0.3\n");
  const std::string bytes = log::ReadBytes(Path("a.lcmlog"));
  log::WriteBytes(Path("b.lcmlog"), bytes.substr(0, bytes.size() - 30));
  const MeasuredRun run = ReadMeasuredRun(Path("b.lcmlog"));
  EXPECT_THAT(run.caution, HasSubstr("incomplete"));
  EXPECT_EQ(NameWithCaution(run), "\"b\" (" + run.caution + ")");
}

// Tests that signals that a log lacks are not measured, and that a log that does not say how the shaft was
// held (an imported table) is refused with the remedy.
TEST_F(MeasuredRunTest, ImportedLog) {
  tables::Table table;
  table.file = "x.csv";
  table.columns = {{"time_s", {0, 1, 2}}, {"voltage_V", {1, 2, 3}}, {"p1_psi", {4, 5, 6}}};
  ImportRun(table, "1.2.3", Path("imported.lcmlog"));
  EXPECT_THAT(
      log::InputErrorOf([&] { ReadMeasuredRun(Path("imported.lcmlog")); }),
      AllOf(HasSubstr(Path("imported.lcmlog")), HasSubstr("how the shaft was held"), HasSubstr("sidecar")));
  const MeasuredRun run =
      RunOfExport(ExportRun(ReadRunLog(Path("imported.lcmlog"))), "[model]\nshaft = \"free\"\n", "");
  EXPECT_THAT(run.voltage.values, ElementsAre(1, 2, 3));
  EXPECT_THAT(run.p1.values, ElementsAre(4, 5, 6));
  EXPECT_FALSE(run.p2.measured());
  EXPECT_FALSE(run.motor_speed.measured());
}

// Tests that a real recording is read through a sidecar: an electro-hydrostatic power take-off whose piston a
// test machine moves.
TEST_F(MeasuredRunTest, BuoyPowerTakeOff) {
  const std::filesystem::path data = std::filesystem::path(HYDRO_MEASURED_DATA) / "buoy_pto";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no measured data at " << data;
  std::filesystem::copy_file(data / "sine_moves_2021-07-26.csv", Path("sine.csv"));
  log::WriteBytes(Path("sine.toml"), R"toml(shaft = "driven"
[columns]
time = "time(s)"
voltage = "WindCurr(A)"
motor_speed = { column = "RPM", scale = 0.10471975512 }
arm_angle = "Pos(in)"
arm_speed = "Spd(in/s)"
p1 = { column = "LowerHydPress(psig)", offset = 14.7 }
p2 = { column = "UpperHydPress(psig)", offset = 14.7 }
)toml");
  const MeasuredRun run = ReadMeasuredRun(Path("sine.csv"));
  EXPECT_EQ(run.shaft, model::Shaft::kDriven);
  EXPECT_EQ(run.voltage.values.front(), -2.205);
  EXPECT_NEAR(run.motor_speed.values.front(), 758.576 * 2 * M_PI / 60, 1e-6);
  EXPECT_NEAR(run.p1.values.front(), -6.855 + 14.7, 1e-12);
  EXPECT_NEAR(run.time.back(), 440, 0.1);
  EXPECT_NEAR(static_cast<double>(run.samples()), 440 * 50, 10);
}

}  // namespace
}  // namespace hydro::runs
