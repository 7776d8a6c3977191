// Times as recorders write them: repeated, rounded, rolled over, set, in bursts, how far apart, and angles
// and commands of few bits.
#include "runs/measured/table_times.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <vector>

#include "base/number_text.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/sample_times.h"
#include "runs/measured/signal_columns.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class TableTimesTest : public log::LogTest {
 protected:
  // A run of a table with the columns t, u and w, with these entries of [columns] for time and besides.
  MeasuredRun Read(const std::string& rows, const std::string& time = "\"t\"",
                   const std::string& more = "motor_speed = \"w\"\n") {
    log::WriteBytes(Path("run.csv"), "t,u,w\n" + rows);
    log::WriteBytes(
        Path("run.toml"),
        "shaft = \"clamped\"\nbypass = true\n[columns]\nvoltage = \"u\"\ntime = " + time + "\n" + more);
    return ReadMeasuredRun(Path("run.csv"));
  }
  std::string ErrorOf(const std::string& rows, const std::string& time = "\"t\"") {
    const std::string error = log::InputErrorOf([&] { Read(rows, time); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }
  // That many rows with the times `time(row)`, and commands that differ from row to row.
  static std::string Rows(int count, const std::function<double(int)>& time) {
    std::string rows;
    for (int row = 0; row < count; ++row)
      rows += NumberText(time(row)) + "," + std::to_string(row % 7) + "," + std::to_string(row) + "\n";
    return rows;
  }
};

// Tests that rows that repeat the one before are left out, and that times that are merely rounded are not.
TEST_F(TableTimesTest, RepeatedRows) {
  const MeasuredRun run = Read("0,1,2\n1,1,2\n1,1,2\n2,1,3\n2,1,3\n");
  EXPECT_THAT(run.time, ElementsAre(0, 1, 2));
  EXPECT_THAT(run.lines, ElementsAre(2, 3, 5));
  EXPECT_THAT(run.layout,
              HasSubstr("2 rows left out that repeat the one before, time and all (the first: line 4)"));
  EXPECT_THAT(ErrorOf("0,1,2\n1,1,2\n1,1,3\n2,1,3\n"),
              AllOf(HasSubstr("line 4, column t: found 1 s, allowed a time above 1 s"),
                    HasSubstr("take one of the two out")));
  EXPECT_THAT(ErrorOf(Rows(4000, [](int row) { return std::floor(row * 0.625) / 1000; })),
              AllOf(HasSubstr("1500 of 4000 rows are like that: the times are rounded"),
                    HasSubstr("every = 0.000625")));
  EXPECT_THAT(ErrorOf(Rows(4000, [](int) { return 7.0; })), HasSubstr("every = T }"));
  EXPECT_THAT(ErrorOf("2,1,2\n1,1,2\n0,1,3\n"), HasSubstr("the last row is the first in time; sort"));
  EXPECT_THAT(ErrorOf("0,1,2\n1,1,2\n0,1,3\n"), HasSubstr("where the recorder began again"));
}

// Tests that times can come from the number of the row.
TEST_F(TableTimesTest, Every) {
  const MeasuredRun run = Read("0,1,2\n0,2,3\n0,3,4\n", "{ every = 0.5 }");
  EXPECT_THAT(run.time, ElementsAre(0, 0.5, 1));
  EXPECT_THAT(run.layout, HasSubstr("times from the number of the row, 0.5 s apart"));
  EXPECT_THAT(ErrorOf("0,1,2\n0,2,3\n", "{ every = 0 }"), HasSubstr("columns.time.every: found 0"));
  EXPECT_THAT(ErrorOf("0,1,2\n0,2,3\n", "{ every = 1, column = \"t\" }"),
              HasSubstr("\"column\": found an unknown key"));
}

// Tests counters of every width, in counts and scaled, from 0 and signed, once and often.
TEST_F(TableTimesTest, RollOvers) {
  const struct {
    int bits;
    double count;  // of the table's number
    bool is_signed;
  } cases[] = {{16, 1, false}, {16, 1, true}, {16, 0.001, false},
               {24, 1, false}, {32, 1, true}, {32, 1e-6, false}};
  for (const auto& one : cases) {
    const double period = std::ldexp(1, one.bits), step = 500, first = period - 20 * step;
    const MeasuredRun run = Read(Rows(400, [&](int row) {
      double counts = std::fmod(first + step * row, period);
      if (one.is_signed) counts = std::remainder(first + step * row - period / 2, period);
      return counts * one.count;
    }));
    ASSERT_EQ(run.samples(), 400u) << one.bits;
    EXPECT_THAT(run.layout, HasSubstr("a counter of " + std::to_string(one.bits) + " bits")) << one.count;
    for (size_t row = 1; row < run.samples(); ++row)
      ASSERT_NEAR(run.time[row] - run.time[row - 1], step * one.count, 1e-6 * step * one.count) << row;
  }
  EXPECT_THAT(ErrorOf(Rows(400, [](int row) { return row % 200 * 0.005; })),
              HasSubstr("the recorder began again"));
  EXPECT_THAT(ErrorOf(Rows(400, [](int row) { return 1.0 * (row % 200); })), Not(HasSubstr("counter")));
}

// Tests times of day over midnight and clocks that are set by an hour, and that clocks with a zone never are.
TEST_F(TableTimesTest, Clocks) {
  const MeasuredRun night = Read("23:59:59.8,1,0\n23:59:59.9,2,0\n00:00:00.0,3,0\n00:00:00.1,4,0\n");
  EXPECT_NEAR(night.time[3] - night.time[0], 0.3, 1e-9);
  EXPECT_THAT(night.layout, HasSubstr("midnight"));
  const MeasuredRun spring = Read(
      "2026-03-29 01:59:59.8,1,0\n2026-03-29 01:59:59.9,2,0\n2026-03-29 03:00:00.0,3,0\n2026-03-29 "
      "03:00:00.1,4,0\n");
  EXPECT_NEAR(spring.time[3], 0.3, 1e-9);
  const MeasuredRun autumn = Read(
      "2026-10-25 02:59:59.8,1,0\n2026-10-25 02:59:59.9,2,0\n2026-10-25 02:00:00.0,3,0\n2026-10-25 "
      "02:00:00.1,4,0\n");
  EXPECT_NEAR(autumn.time[3], 0.3, 1e-9);
  EXPECT_THAT(autumn.layout, HasSubstr("set by an hour (line 4: summer time)"));
  const MeasuredRun zone =
      Read("2026-03-29T01:59:59.9Z,1,0\n2026-03-29T02:00:00.0Z,2,0\n2026-03-29T03:00:00.1Z,3,0\n");
  EXPECT_NEAR(zone.time[2], 3600.2, 1e-9);
  EXPECT_THAT(
      log::InputErrorOf([&] { Read("10:30:25,1,0\n10:30:26,2,0\n", "{ column = \"t\", unit = \"ms\" }"); }),
      HasSubstr("found a unit or a scale for dates or times of day"));
}

// Tests the sidecar's word on dates that can be read in two ways, and its mistakes.
TEST_F(TableTimesTest, OrderOfDates) {
  const std::string rows = "1/2/2026 23:59:59,1,2\n2/2/2026 00:00:00,1,3\n2/2/2026 00:00:01,2,3\n";
  EXPECT_THAT(ErrorOf(rows), HasSubstr("or time = { column = \"t\", date_order = \"dmy\" } in the sidecar"));
  EXPECT_THAT(Read(rows, "{ column = \"t\", date_order = \"dmy\" }").time, ElementsAre(0, 1, 2));
  EXPECT_THAT(ErrorOf(rows, "{ column = \"t\", date_order = \"xyz\" }"),
              HasSubstr("columns.time.date_order: found \"xyz\", allowed \"dmy\", \"mdy\" or \"ymd\""));
}

// Tests a date in a column of its own, and nanoseconds since 1970.
TEST_F(TableTimesTest, DatesAndNanoseconds) {
  log::WriteBytes(Path("d.csv"), "day,t,u\n2026-01-31,23:59:59.5,1\n2026-02-01,00:00:00.5,2\n");
  log::WriteBytes(
      Path("d.toml"),
      "shaft = \"free\"\n[columns]\ntime = { column = \"t\", date = \"day\" }\nvoltage = \"u\"\n");
  EXPECT_THAT(ReadMeasuredRun(Path("d.csv")).time, ElementsAre(0, 1));
  log::WriteBytes(
      Path("d.toml"),
      "shaft = \"free\"\n[columns]\ntime = { column = \"t\", date = \"Day\" }\nvoltage = \"u\"\n");
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("d.csv")); }),
              AllOf(HasSubstr("columns.time.date: found \"Day\""), HasSubstr("did you mean \"day\"")));
  const MeasuredRun run = Read("1767263425000000000,1,0\n1767263425000500000,2,0\n1767263425001000000,3,0\n",
                               "{ column = \"t\", unit = \"ns\" }");
  EXPECT_THAT(run.time, ElementsAre(0, 0.0005, 0.001));
  EXPECT_THAT(run.layout, HasSubstr("times counted from 1767263425000000000"));
}

// Tests that times of arrival are refused, and uneven times of other causes are not.
TEST_F(TableTimesTest, Bursts) {
  EXPECT_THAT(ErrorOf(Rows(400, [](int row) { return row / 20 * 0.1 + row % 20 * 3e-6; })),
              AllOf(HasSubstr("samples in bursts, 20 within 57 us each 100 ms"), HasSubstr("every = 0.005")));
  EXPECT_THAT(ErrorOf(Rows(4000, [](int row) { return row / 256 * 0.064 + row % 256 * 1e-6; })),
              HasSubstr("256 within"));
  EXPECT_EQ(Read(Rows(400, [](int row) { return row / 2 * 0.005 + row % 2 * 0.0012; })).samples(),
            400u);  // two topics
  EXPECT_EQ(Read(Rows(400, [](int row) { return row / 100 * 10.0 + row % 100 * 0.001; })).samples(),
            400u);  // four records
  EXPECT_EQ(Read(Rows(400, [](int row) { return row * 0.005 + (row > 200 ? 2 : 0); })).samples(),
            400u);  // one gap
}

// Tests that angles of few bits, or of one revolution, are counted on.
TEST_F(TableTimesTest, AnglesThatRollOver) {
  const auto read = [&](double period, const std::string& entry) {
    std::string rows;
    for (int row = 0; row < 300; ++row) {
      const double counts = std::fmod(40.0 * row, period);
      rows += NumberText(0.01 * row) + ",1," + NumberText(counts) + "\n";
    }
    return Read(rows, "\"t\"", entry);
  };
  const MeasuredRun encoder = read(4096, "motor_angle = { column = \"w\", scale = 0.001 }\n");
  EXPECT_NEAR(encoder.motor_angle.values[299], 0.04 * 299, 1e-9);
  EXPECT_THAT(encoder.layout, HasSubstr("motor_angle counted on where it rolls over (2 times, the first in "
                                        "line 105, column w: a period of 4096"));
  const MeasuredRun degrees = read(360, "motor_angle = { column = \"w\", unit = \"deg\" }\n");
  EXPECT_NEAR(degrees.motor_angle.values[299], 40 * 299 * M_PI / 180, 1e-6);
  const MeasuredRun speed = read(4096, "motor_speed = \"w\"\n");
  EXPECT_NEAR(speed.motor_speed.values[299], std::fmod(40.0 * 299, 4096), 1e-9);  // no angle
}

// Tests that a gap does not change the usual interval, and that recordings are taken together.
TEST(MedianInterval, OfOneAndOfSeveralRecordings) {
  const std::vector<double> slow = {0, 1, 2, 50};
  const std::vector<double> fast = {0, 0.25, 0.5, 0.75, 1, 1.25};
  EXPECT_EQ(MedianInterval(slow), 1);
  EXPECT_EQ(MedianInterval(std::vector{&slow, &fast}), 0.25);
  EXPECT_EQ(MedianInterval(std::vector<double>{3}), 1);
}

}  // namespace
}  // namespace hydro::runs
