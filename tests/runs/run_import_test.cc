#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <random>

#include "base/input_error.h"
#include "base/read_files.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class RunImportTest : public log::LogTest {
 protected:
  RunLog Import(const tables::Table& table) {
    ForgetRead(Path("log"));  // each import stands for another process
    ImportRun(table, "1.2.3", Path("log"));
    return ReadRunLog(Path("log"));
  }
  RunLog ImportCsv(const std::string& text) {
    log::WriteBytes(Path("x.csv"), text);
    return Import(tables::ReadTable(Path("x.csv")));
  }

  // Expects that export returns the columns of `table` bit by bit, and nothing in the others.
  void ExpectComesBack(const tables::Table& table) {
    const tables::Table back = ExportRun(Import(table));
    ASSERT_EQ(back.rows(), table.rows());
    for (const tables::Column& column : back.columns) {
      const tables::Column* given = table.Find(column.name);
      for (size_t row = 0; row < table.rows(); ++row) {
        double expected = kNan;
        if (given != nullptr) expected = given->values[row];
        if (given == nullptr && column.name == "tick") expected = static_cast<double>(row);
        const double found = column.values[row];
        ASSERT_TRUE(std::bit_cast<uint64_t>(found) == std::bit_cast<uint64_t>(expected) ||
                    (std::isnan(found) && std::isnan(expected)))
            << column.name << " row " << row << ": " << found << " instead of " << expected;
      }
    }
  }
};

// Any numbers, a third of them missing.
tables::Table RandomTable(uint64_t seed, size_t rows, unsigned columns) {
  std::mt19937_64 random(seed);
  tables::Table table;
  table.file = "random.csv";
  for (size_t k = 0; k < kRunColumns.size(); ++k) {
    if (k > 0 && ((columns >> k) & 1) == 0) continue;
    tables::Column column{kRunColumns[k], {}};
    double time = -1;
    double tick = -1;
    for (size_t row = 0; row < rows; ++row) {
      time += 1e-6 + static_cast<double>(random() % 100000) * 1e-5;
      tick += static_cast<double>(1 + (random() % 3 == 0 ? random() % 5 : 0));
      double value = random() % 3 == 0 ? kNan : std::bit_cast<double>(random());
      if (random() % 5 == 0) value = -0.0;
      column.values.push_back(k == 0 ? time : k == 1 ? tick : value);
    }
    table.columns.push_back(column);
  }
  return table;
}

// Tests that every subset of the columns that has time_s comes back bit by bit, with gaps in the ticks and
// missing values.
TEST_F(RunImportTest, EverySubsetOfColumnsComesBack) {
  for (unsigned columns = 1; columns < 1u << kRunColumns.size(); columns += 2) {
    SCOPED_TRACE(columns);
    ExpectComesBack(RandomTable(columns, 1 + columns % 7, columns));
    std::filesystem::remove(Path("log"));
    if (HasFatalFailure()) return;
  }
}

// Tests that an exported run survives import and export unchanged.
TEST_F(RunImportTest, ExportedRunComesBack) {
  log::WriteRun(Path("run"), log::SampleRun(50));
  ExpectComesBack(ExportRun(ReadRunLog(Path("run"))));
}

// Tests that tables in the units of other systems, as export writes them, come back bit by bit in logs that
// say their units.
TEST_F(RunImportTest, OtherUnitsComeBack) {
  const UnitSystem systems[] = {kSiUnits, {"mm", "N"}, {"cm", "daN"}, {"mm", "N", true}, {"in", "lbf", true}};
  for (const UnitSystem& units : systems) {
    SCOPED_TRACE(RunColumnIn(units, "arm_speed_rad_s") + ", " + RunColumnIn(units, "p1_psi"));
    const tables::Table paper = RandomTable(5, 20, ~0u);
    tables::Table named = paper;
    for (tables::Column& column : named.columns) column.name = RunColumnIn(units, column.name);
    EXPECT_EQ(named.columns[9].name, "p1_" + units.UnitFor("psi"));
    const RunLog log = Import(named);
    EXPECT_EQ(ModelUnits(log.messages.Of<run_description_t>().at(0), "log"), units);
    const tables::Table back = ExportRun(log);
    for (size_t k = 0; k < paper.columns.size(); ++k) {
      for (size_t row = 0; row < paper.rows(); ++row) {
        const double given = paper.columns[k].values[row], found = back.columns[k].values[row];
        EXPECT_TRUE(given == found || (std::isnan(given) && std::isnan(found))) << named.columns[k].name;
      }
    }
    std::filesystem::remove(Path("log"));
  }
}

// Tests that columns of no one system are refused.
TEST_F(RunImportTest, MixedUnitsAreRefused) {
  try {
    ImportCsv("time_s,p1_Pa,p2_psi\n0,1,1\n1,1,1\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("found the column 'p1_Pa'"));
    EXPECT_THAT(error.what(), HasSubstr("or all of them in other units of one system"));
  }
}

// Tests that the log plays at the pace of the measurement and describes itself.
TEST_F(RunImportTest, TimesAndDescription) {
  const RunLog even = ImportCsv("time_s,p1_psi\n0.5,1\n0.502,2\n0.504,3\n");
  EXPECT_EQ(even.first_utime, 500000);
  EXPECT_EQ(even.last_utime, 504000);
  ASSERT_EQ(even.messages.Of<run_description_t>().size(), 1u);
  EXPECT_EQ(even.messages.Of<run_description_t>()[0].rate_hz, 500);
  EXPECT_EQ(even.messages.Of<run_description_t>()[0].program, "hydro-log");
  EXPECT_EQ(even.messages.Of<run_description_t>()[0].version, "1.2.3");
  EXPECT_EQ(even.messages.Of<run_description_t>()[0].config_file, Path("x.csv"));
  EXPECT_EQ(ImportCsv("time_s,tick\n0,0\n0.002,2\n0.003,3\n").messages.Of<run_description_t>()[0].rate_hz,
            1000);
  EXPECT_EQ(ImportCsv("time_s\n0\n0.002\n0.003\n").messages.Of<run_description_t>()[0].rate_hz, 0);
  EXPECT_EQ(ImportCsv("time_s\n7\n").messages.Of<run_description_t>()[0].rate_hz, 0);
}

// Tests that a voltage acts from its row on, as in a log of the plant.
TEST_F(RunImportTest, VoltageActsFromItsRow) {
  const RunLog log = ImportCsv("time_s,voltage_V\n0,1\n1,2\n2,3\n");
  ASSERT_EQ(log.messages.Of<state_t>().size(), 3u);
  EXPECT_EQ(log.messages.Of<state_t>()[0].voltage, 0);
  EXPECT_EQ(log.messages.Of<state_t>()[0].command_tick, -1);
  EXPECT_EQ(log.messages.Of<state_t>()[1].voltage, 1);
  EXPECT_EQ(log.messages.Of<state_t>()[2].voltage, 2);
  EXPECT_EQ(log.messages.Of<state_t>()[2].command_tick, 1);
  ASSERT_EQ(log.messages.Of<motor_command_t>().size(), 1u);
  EXPECT_EQ(log.messages.Of<motor_command_t>()[0].tick, 1);
  EXPECT_EQ(log.messages.Of<motor_command_t>()[0].voltage, 3);
}

// Tests that each kind of bad table is an error that names row and column, and that no log is left.
TEST_F(RunImportTest, BadTables) {
  const struct {
    const char* text;
    const char* says;
  } cases[] = {
      {"p1_psi\n1\n", ": found no column time_s"},
      {"time_s,p3_psi\n0,1\n", ": found the column 'p3_psi'; allowed are time_s, tick, voltage_V"},
      {"time_s,time_s\n0,1\n", ": line 1, column 2: found the name \"time_s\" a second time"},
      {"time_s,p1_psi\n0,1\n0,2\n", ": line 3, column time_s: found 0; a time after 0"},
      {"time_s,p1_psi\n0,1\n2,2\n1,2\n", ": line 4, column time_s: found 1; a time after 2"},
      {"time_s,p1_psi\n0,1\n,2\n", ": line 3, column time_s: found nothing"},
      {"time_s,p1_psi\n0,1\ninf,2\n", ": line 3, column time_s: found inf"},
      {"time_s,p1_psi\n0,1\n1e13,2\n", ": line 3, column time_s: found 1e+13"},
      {"time_s,tick\n0,0\n1,1.5\n", ": line 3, column tick: found 1.5; a whole number"},
      {"time_s,tick\n0,-1\n", ": line 2, column tick: found -1; a whole number from 0"},
      {"time_s,tick\n0,\n", ": line 2, column tick: found nothing; a whole number"},
      {"time_s,tick\n0,1e300\n", ": line 2, column tick: found 1e+300"},
      {"time_s,tick\n0,3\n1,3\n", ": line 3, column tick: found 3; a tick above 3"},
      {"time_s,p1_psi\n0,abc\n", ": line 2, column p1_psi: found \"abc\""},
      {"time_s,p1_psi\n0\n", ": line 2: found 1 cells, allowed 2"},
      {"", ": found no line of column names"},
  };
  for (const auto& bad : cases) {
    EXPECT_THAT(log::InputErrorOf([&] { ImportCsv(bad.text); }), HasSubstr(Path("x.csv") + bad.says));
    EXPECT_FALSE(std::filesystem::exists(Path("log"))) << bad.says;
    EXPECT_FALSE(std::filesystem::exists(Path("log.part"))) << bad.says;
  }
}

}  // namespace
}  // namespace hydro::runs
