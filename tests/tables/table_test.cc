#include "tables/table.h"

#include <gmock/gmock.h>
#include <matio.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "tests/log/log_fixture.h"

namespace hydro::tables {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TableTest : public log::LogTest {
 protected:
  Table Csv(const std::string& text) {
    log::WriteBytes(Path("x.csv"), text);
    return ReadTable(Path("x.csv"));
  }
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Equal bit by bit, except that every NaN counts as a missing value.
void ExpectSame(const Table& a, const Table& b) {
  ASSERT_EQ(a.columns.size(), b.columns.size());
  ASSERT_EQ(a.rows(), b.rows());
  for (size_t k = 0; k < a.columns.size(); ++k) {
    EXPECT_EQ(a.columns[k].name, b.columns[k].name);
    for (size_t row = 0; row < a.rows(); ++row) {
      const double x = a.columns[k].values[row];
      const double y = b.columns[k].values[row];
      EXPECT_TRUE(std::bit_cast<uint64_t>(x) == std::bit_cast<uint64_t>(y) ||
                  (std::isnan(x) && std::isnan(y)))
          << a.columns[k].name << " row " << row << ": " << x << " and " << y;
    }
  }
}

Table HardTable() {
  using Limits = std::numeric_limits<double>;
  Table table;
  table.columns = {{"time_s", {0, 0.1, 1.0 / 3, 1e300}},
                   {"hard", {-0.0, Limits::denorm_min(), Limits::max(), Limits::lowest()}},
                   {"more", {Limits::infinity(), -Limits::infinity(), kNan, Limits::epsilon()}}};
  std::mt19937_64 random(5);
  for (Column& column : table.columns) {
    for (int k = 0; k < 2000; ++k) column.values.push_back(std::bit_cast<double>(random()));  // any bits
  }
  return table;
}

// Tests that every double comes back bit by bit from both kinds of file.
TEST_F(TableTest, RoundTrip) {
  const Table table = HardTable();
  for (const char* name : {"x.csv", "x.mat"}) {
    WriteTable(table, Path(name));
    ExpectSame(ReadTable(Path(name)), table);
    EXPECT_FALSE(std::filesystem::exists(Path(name) + std::string(".part")));
  }
}

// Tests the text of a CSV file: shortest numbers, missing values empty.
TEST_F(TableTest, CsvText) {
  Table table;
  table.columns = {{"a", {0.1, 1e21}}, {"b", {kNan, -0.0}}, {"c", {100, kNan}}};
  WriteTable(table, Path("x.csv"));
  EXPECT_EQ(log::ReadBytes(Path("x.csv")), "a,b,c\n0.1,,100\n1e+21,-0,\n");
}

// Tests that a table of one column can have missing values.
TEST_F(TableTest, OneColumn) {
  Table table;
  table.columns = {{"a", {1, kNan, 2}}};
  WriteTable(table, Path("x.csv"));
  ExpectSame(ReadTable(Path("x.csv")), table);
}

// Tests variants of CSV files that other programs write.
TEST_F(TableTest, CsvOfOthers) {
  const Table table =
      Csv("\xef\xbb\xbf\"time_s\" , WindCurr(A),\"a, b\"\r\n 0 ,+1.5, \"2\"\r\n1,NaN,\r\n\r\n");
  Table expected;
  expected.columns = {{"time_s", {0, 1}}, {"WindCurr(A)", {1.5, kNan}}, {"a, b", {2, kNan}}};
  ExpectSame(table, expected);
  EXPECT_EQ(table.Place(1, "time_s"), Path("x.csv") + ": line 3, column time_s");
}

// Tests that comments and blank lines are skipped and lines still counted, and that names may stand in a
// comment.
TEST_F(TableTest, CommentsAndBlankLines) {
  const Table table = Csv("# recorded on the bench\n\na,b\n1,2\n\n# pause\n3,4\n#end\n");
  Table expected;
  expected.columns = {{"a", {1, 3}}, {"b", {2, 4}}};
  ExpectSame(table, expected);
  EXPECT_EQ(table.Place(1, "b"), Path("x.csv") + ": line 7, column b");
  const Table commented = Csv("# bench\n#time,p1\n1,\n3,\" 4\"\n");
  expected.columns = {{"#time", {1, 3}}, {"p1", {kNan, 4}}};
  ExpectSame(commented, expected);
  EXPECT_EQ(commented.Place(0, "p1"), Path("x.csv") + ": line 3, column p1");
  EXPECT_THAT(log::InputErrorOf([&] { Csv("#a\n"); }), HasSubstr(": found no rows, allowed one or more"));
}

// Tests that a last line without an end is a row.
TEST_F(TableTest, NoNewlineAtTheEnd) { EXPECT_EQ(Csv("a,b\n1,2\n3,4").rows(), 2u); }

// Tests that each kind of malformed CSV is an error that names the place.
TEST_F(TableTest, MalformedCsv) {
  const struct {
    std::string text;
    const char* says;
  } cases[] = {
      {"", ": found no line of column names"},
      {"\n", ": found no line of column names"},
      {"a,b\n", ": found no rows, allowed one or more"},
      {"a,,b\n1,2,3\n", ": line 1, column 2: found no name"},
      {"a,b,a\n1,2,3\n", ": line 1, column 3: found the name \"a\" a second time"},
      {"a,b\n1,2\n3\n", ": line 3: found 1 cells, allowed 2, as many as there are names"},
      {"a,b\n1,2,3\n", ": line 2: found 3 cells, allowed 2"},
      {"a,b\n1,2\n3,4 5\n", ": line 3, column b: found \"4 5\", allowed a number, nan or an empty cell"},
      {"a,b\n1,0x10\n", ": line 2, column b: found \"0x10\""},
      {"a,b\n1,1e999\n", ": line 2, column b: found \"1e999\""},
      {"a,b\n1,--2\n", ": line 2, column b: found \"--2\""},
      {"a,b\n1,+-2\n", ": line 2, column b: found \"+-2\""},
      {"a;b\n1 2\n", ": line 2: found numbers without as many names in the line above"},
      {std::string("a,b\n1,\0\n", 8), ": line 2, column b: found \"\\x00\""},
  };
  for (const auto& bad : cases) {
    EXPECT_THAT(log::InputErrorOf([&] { Csv(bad.text); }), HasSubstr(Path("x.csv") + bad.says));
  }
}

// Writes one MAT variable.
void WriteVariable(const std::string& file, const char* name, matio_classes kind, matio_types type,
                   size_t rows, size_t columns, void* data, int flags = 0) {
  mat_t* mat = Mat_CreateVer(file.c_str(), nullptr, MAT_FT_MAT5);
  ASSERT_NE(mat, nullptr);
  size_t dimensions[2] = {rows, columns};
  matvar_t* variable = Mat_VarCreate(name, kind, type, 2, dimensions, data, flags);
  ASSERT_EQ(Mat_VarWrite(mat, variable, MAT_COMPRESSION_ZLIB), 0);
  Mat_VarFree(variable);
  Mat_Close(mat);
}

// Tests that vectors of any number type and orientation, compressed too, are read, and nothing else.
TEST_F(TableTest, MatOfOthers) {
  int32_t whole[3] = {1, -2, 3};
  WriteVariable(Path("x.mat"), "row", MAT_C_INT32, MAT_T_INT32, 1, 3, whole);
  Table expected;
  expected.columns = {{"row", {1, -2, 3}}};
  ExpectSame(ReadTable(Path("x.mat")), expected);

  double numbers[4] = {1, 2, 3, 4};
  WriteVariable(Path("x.mat"), "square", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, 2, numbers);
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("x.mat")); }),
              AllOf(HasSubstr(Path("x.mat") + ": column 'square': found 2x2 numbers; a vector is needed")));
  char text[] = "abc";
  WriteVariable(Path("x.mat"), "text", MAT_C_CHAR, MAT_T_UINT8, 1, 3, text);
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("x.mat")); }), HasSubstr("column 'text': found text"));
}

// Tests that columns of unequal length, no column at all and something else than a MAT file are errors.
TEST_F(TableTest, MalformedMat) {
  Table table;
  table.columns = {{"a", {1, 2}}, {"b", {3, 4}}};
  WriteTable(table, Path("x.mat"));
  const std::string bytes = log::ReadBytes(Path("x.mat"));
  log::WriteBytes(Path("y.mat"), bytes.substr(0, 128));  // the header alone
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("y.mat")); }),
              HasSubstr(Path("y.mat") + ": found no rows"));
  log::WriteBytes(Path("y.mat"), "time_s,tick\n0,1\n");
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("y.mat")); }),
              HasSubstr(Path("y.mat") + ": found no MAT file"));
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("none.mat")); }), HasSubstr("No such file"));
  // Two files of one vector each, put together.
  double numbers[3] = {1, 2, 3};
  WriteVariable(Path("one.mat"), "three", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, 1, numbers);
  log::WriteBytes(Path("y.mat"), bytes + log::ReadBytes(Path("one.mat")).substr(128));
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("y.mat")); }),
              HasSubstr("column 'three': found 3 rows; 2 are needed"));
}

// Tests that a MAT file cut at any byte gives an error or the columns that are still whole, never a wrong
// number.
TEST_F(TableTest, TruncatedMat) {
  Table table;
  table.columns = {{"a", {1, 2, 3}}, {"b", {3, 4, 5}}};
  WriteTable(table, Path("x.mat"));
  const std::string bytes = log::ReadBytes(Path("x.mat"));
  for (size_t size = 0; size < bytes.size(); ++size) {
    log::WriteBytes(Path("cut.mat"), bytes.substr(0, size));
    try {
      const Table cut = ReadTable(Path("cut.mat"));
      Table expected;
      expected.columns = {table.columns[0]};
      ExpectSame(cut, expected);
    } catch (const InputError&) {
    }
  }
}

// Tests that a name without a known format is refused.
TEST_F(TableTest, UnknownFormat) {
  EXPECT_THAT(log::InputErrorOf([&] { WriteTable(HardTable(), Path("x.txt")); }),
              HasSubstr("end in .csv or .mat"));
}

// Tests which names tell a table, in capitals too.
TEST(TableNamesTest, TellTables) {
  for (const char* name : {"run.csv", "Run.CSV", "a/b.c/run.txt", "run.tsv", "run.DAT", "run.mat"}) {
    EXPECT_TRUE(IsTable(name)) << name;
  }
  for (const char* name : {"run.lcmlog", "run", "csv", "run.csv.toml"}) EXPECT_FALSE(IsTable(name)) << name;
}

}  // namespace
}  // namespace hydro::tables
