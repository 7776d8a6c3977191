#include "settings/trajectory_spec.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::HasSubstr;

// Tests that the two columns are found by name, whatever else the table holds.
TEST(CsvPointsTest, ReadsColumnsByName) {
  const auto points = ParseCsvPoints(
      "\xEF\xBB\xBF# recorded\r\nother, \"time_s\" ,arm_ref_rad\r\n9,0,0.1\r\n\r\n,0.5,-2e-3\r\n9,+1,3\n",
      "a.csv", "arm_ref_rad");
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[1].time, 0.5);
  EXPECT_EQ(points[1].value, -2e-3);
  EXPECT_EQ(points[2].time, 1.0);
}

// Tests that semicolons, tabs and decimal commas, as a spreadsheet writes them, are read.
TEST(CsvPointsTest, OtherSeparators) {
  for (const char* text : {"time_s;y\n0;0,25\n0,5;-1,5\n", "time_s;y\n0;0.25\n0.5;-1.5\n",
                           "time_s\ty\n0\t0.25\n0.5\t-1.5\n", "x;time_s;y\n7;0;0,25\n8;0,5;-1,5\n"}) {
    const auto points = ParseCsvPoints(text, "a.csv", "y");
    ASSERT_EQ(points.size(), 2u) << text;
    EXPECT_EQ(points[0].value, 0.25);
    EXPECT_EQ(points[1].time, 0.5);
    EXPECT_EQ(points[1].value, -1.5);
  }
}

// Tests that what is cut in a column that nobody asks for is no harm.
TEST(CsvPointsTest, AnotherColumnMayBeCut) {
  const auto points = ParseCsvPoints("time_s,y,note\n0,0.25,1\n1,0.5,1", "a.csv", "y");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].value, 0.5);
}

// Tests that each malformed table is refused with file, row, column, what was found and what is allowed.
TEST(CsvPointsTest, RefusesMalformedTables) {
  const struct {
    const char* text;
    const char* says;
  } tables[] = {
      {"", "a.csv: found no line of column names, allowed one above the rows"},
      {"# only a comment\n", "a.csv: line 1: found no column \"time_s\", allowed \"# only a comment\""},
      {"time_s,y\n", "a.csv: found no rows, allowed one or more below the column names"},
      {"t,y\n0,1\n", "a.csv: line 1: found no column \"time_s\", allowed \"t\" or \"y\""},
      {"time_s,Y2\n0,1\n", "a.csv: line 1: found no column \"y\", allowed \"time_s\" or \"Y2\""},
      {"time_s,y,y\n0,1,1\n", "a.csv: line 1: found two columns \"y\", allowed one"},
      {"time_s,y\n0,1\n1\n", "a.csv: line 3: found 1 cells, allowed 2, as many as there are names"},
      {"time_s,y\n0,1,2\n", "a.csv: line 2: found 3 cells, allowed 2"},
      {"time_s,y\n0,one\n", "a.csv: line 2, column y: found \"one\", allowed a finite number"},
      {"time_s,y\n0,1e\n", "a.csv: line 2, column y: found \"1e\", allowed a finite number"},
      {"time_s,y\n0,1 2\n", "a.csv: line 2, column y: found \"1 2\", allowed a finite number"},
      {"time_s,y\n0,nan\n", "a.csv: line 2, column y: found \"nan\", allowed a finite number"},
      {"time_s,y\n0,1e999\n", "a.csv: line 2, column y: found \"1e999\", allowed a finite number"},
      {"time_s,y\n0,\n", "a.csv: line 2, column y: found \"\", allowed a finite number"},
      {"time_s,y\n-inf,0\n", "a.csv: line 2, column time_s: found \"-inf\", allowed a finite number"},
      {"time_s,y\n0,1\n# x\n0,2\n",
       "a.csv: line 4, column time_s: found \"0\", allowed above 0, the time of the row before"},
      {"time_s,y\n0,0.25\n1,0.5",
       "a.csv: line 3, column y: found \"0.5\", allowed a number before the end of a line: the file may be "
       "cut within it"},
      {"y,time_s\n0.25,0\n0.5,1",
       "a.csv: line 3, column time_s: found \"1\", allowed a number before the end of a line"},
      {"time_s;y\n0;one\n", "a.csv: line 2, column y: found \"one\", allowed a finite number"},
      {"time_s;y\n0;0\n1;1e999\n", "a.csv: line 3, column y: found \"1e999\", allowed a finite number"},
      {"time_s;x\n0;1\n1;2\n", "a.csv: line 1: found no column \"y\", allowed \"time_s\" or \"x\""},
  };
  for (const auto& table : tables) {
    EXPECT_THAT(settings::InputErrorOf([&] { ParseCsvPoints(table.text, "a.csv", "y"); }),
                HasSubstr(table.says));
  }
}

}  // namespace
}  // namespace hydro::settings
