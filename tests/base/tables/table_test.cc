#include "base/tables/table.h"

#include <gmock/gmock.h>
#include <matio.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "tests/runs/log/log_fixture.h"

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

// Tests that carriage returns alone end lines, too, where they end all of them, and that the table says so.
TEST_F(TableTest, CarriageReturnsAlone) {
  const Table table = Csv("a,b\r1,2\r3,4\r");
  Table expected;
  expected.columns = {{"a", {1, 3}}, {"b", {2, 4}}};
  ExpectSame(table, expected);
  EXPECT_EQ(table.Place(1, "b"), Path("x.csv") + ": line 3, column b");
  EXPECT_THAT(table.layout, HasSubstr("carriage returns as line ends"));
  EXPECT_THAT(log::InputErrorOf([&] { Csv("a,b\r1,2\n3,4\n"); }), HasSubstr(": "));
}

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
      {"a,b\n1,2\na,b\n3,4\n",
       ": line 3, column a: found \"a\", allowed a number, nan or an empty cell; "
       "where the names stand again, cut the table in two"},
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

// A struct, which takes the fields over.
matvar_t* Struct(const char* name, const std::vector<std::pair<const char*, matvar_t*>>& fields) {
  std::vector<const char*> names;
  for (const auto& field : fields) names.push_back(field.first);
  size_t one[2] = {1, 1};
  matvar_t* made = Mat_VarCreateStruct(name, 2, one, names.data(), static_cast<unsigned>(names.size()));
  for (const auto& [field, value] : fields) Mat_VarSetStructFieldByName(made, field, 0, value);
  return made;
}

matvar_t* Vector(const std::vector<double>& values, const char* name = nullptr) {
  size_t dimensions[2] = {values.size(), 1};
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dimensions, const_cast<double*>(values.data()),
                       0);
}

void WriteVariables(const std::string& file, mat_ft version, const std::vector<matvar_t*>& variables) {
  mat_t* mat = Mat_CreateVer(file.c_str(), nullptr, version);
  ASSERT_NE(mat, nullptr);
  for (matvar_t* variable : variables) {
    EXPECT_EQ(Mat_VarWrite(mat, variable, MAT_COMPRESSION_NONE), 0);
    Mat_VarFree(variable);
  }
  Mat_Close(mat);
}

matvar_t* MeasuredStruct() {
  char note[] = "rig 2";
  size_t length[2] = {1, 5};
  return Struct("data", {{"t", Vector({0, 1, 2})},
                         {"motor", Struct(nullptr, {{"w", Vector({5, 6, 7})}})},
                         {"fs", Vector({1000})},
                         {"note", Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UINT8, 2, length, note, 0)}});
}

// Tests that vectors in structs are columns, in both versions of the format, and that what is no signal is
// left out with the reason.
TEST_F(TableTest, MatStructs) {
  Table expected;
  expected.columns = {{"data.t", {0, 1, 2}}, {"data.motor.w", {5, 6, 7}}};
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    WriteVariables(Path("x.mat"), version, {MeasuredStruct(), Vector({4}, "gain")});
    Table table = ReadTable(Path("x.mat"));
    ForgetRead(Path("x.mat"));
    ExpectSame(table, expected);
    ASSERT_EQ(table.left_out.size(), 3u);
    EXPECT_THAT(table.WhyNot("data.fs"),
                HasSubstr("found 1 rows; 3 are needed, as many as its signals have"));
    EXPECT_THAT(table.WhyNot("data.note"), HasSubstr("found text"));
    EXPECT_THAT(table.WhyNot("gain"), HasSubstr("found 1 rows"));
    EXPECT_EQ(table.WhyNot("data.t"), "");
    TakeStructOf("t", &table);
    ASSERT_EQ(table.columns.size(), 1u);
    EXPECT_EQ(table.columns[0].name, "t");
    EXPECT_THAT(table.WhyNot("data.motor.w"), HasSubstr("outside the struct"));
  }
}

// Tests that a struct without a signal, and an array of structs, are errors that say what was found.
TEST_F(TableTest, MatStructsWithoutSignals) {
  WriteVariables(Path("x.mat"), MAT_FT_MAT5, {Struct("data", {{"t", Vector({})}})});
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("x.mat")); }), HasSubstr("x.mat: found no rows"));
  const char* names[] = {"t"};
  size_t two[2] = {1, 2};
  matvar_t* pair = Mat_VarCreateStruct("data", 2, two, names, 1);
  Mat_VarSetStructFieldByName(pair, "t", 0, Vector({1, 2}));
  Mat_VarSetStructFieldByName(pair, "t", 1, Vector({3, 4}));
  WriteVariables(Path("y.mat"), MAT_FT_MAT5, {pair});
  EXPECT_THAT(log::InputErrorOf([&] { ReadTable(Path("y.mat")); }),
              HasSubstr("data: found 1x2 structs; one struct"));
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
