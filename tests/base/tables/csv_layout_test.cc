#include "base/tables/csv_layout.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/tables/csv_cells.h"
#include "base/tables/table.h"
#include "base/tables/text_encoding.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::tables {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class CsvLayoutTest : public log::LogTest {
 protected:
  Table Read(const std::string& text, const CsvSettings& settings = {}) {
    log::WriteBytes(Path("x.csv"), text);
    return ReadTable(Path("x.csv"), settings);
  }
  std::string ErrorOf(const std::string& text, const CsvSettings& settings = {}) {
    const std::string error = log::InputErrorOf([&] { Read(text, settings); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }
};

// The table that every text below holds: t = 0, 0.5, 1 and p1 = 12.25, 13.5, 14.
void ExpectTheTable(const Table& table, const std::string& layout) {
  ASSERT_EQ(table.columns.size(), 2u) << layout;
  EXPECT_EQ(table.columns[0].name, "t") << layout;
  EXPECT_EQ(table.columns[1].name, "p1") << layout;
  EXPECT_THAT(table.columns[0].values, ElementsAre(0, 0.5, 1)) << layout;
  EXPECT_THAT(table.columns[1].values, ElementsAre(12.25, 13.5, 14)) << layout;
  EXPECT_EQ(table.layout, layout);
}

// Tests every separator with both signs of decimals, and what is said of each.
TEST_F(CsvLayoutTest, SeparatorsAndDecimals) {
  ExpectTheTable(Read("t,p1\n0,12.25\n0.5,13.5\n1,14\n"), "");
  ExpectTheTable(Read("t;p1\n0;12.25\n0.5;13.5\n1;14\n"), "semicolons between cells");
  ExpectTheTable(Read("t;p1\n0;12,25\n0,5;13,5\n1;14\n"), "semicolons between cells, decimal commas");
  ExpectTheTable(Read("t\tp1\r\n0\t12,25\r\n0,5\t13,5\r\n1\t14\r\n"), "tabs between cells, decimal commas");
  ExpectTheTable(Read("t\tp1\n0\t12.25\n0.5\t13.5\n1\t14\n"), "tabs between cells");
  ExpectTheTable(Read("  t    p1\n  0   12.25\n0.5 13.5\n 1   14\n"), "blanks between cells");
  ExpectTheTable(Read("t p1\n0 12,25\n0,5 13,5\n1 14\n"), "blanks between cells, decimal commas");
  ExpectTheTable(Read("\"t\",\"p1\"\n\"0\",\"12,25\"\n\"0,5\",\"13,5\"\n\"1\",\"14\"\n"), "decimal commas");
}

// Tests texts before the names, comments among them, and that messages still count the file's lines.
TEST_F(CsvLayoutTest, Preambles) {
  const std::string rows = "0;12,25\n0,5;13,5\n1;14\n";
  const Table table = Read("Recorder 7\nDate;2021-07-26\n\nChannels;2\n# bench\n12\nt;p1\n" + rows);
  ExpectTheTable(table, "semicolons between cells, decimal commas, names after line 6");
  EXPECT_EQ(table.Place(0, "t"), Path("x.csv") + ": line 8, column t");
  ExpectTheTable(Read("sep=;\nt;p1\n" + rows),
                 "semicolons between cells, decimal commas, names after line 1");
  ExpectTheTable(Read("Operator, Smith\nBench, 4\nt,p1\n0,12.25\n0.5,13.5\n1,14\n"), "names after line 2");
  ExpectTheTable(Read("# bench\nt;p1\n" + rows), "semicolons between cells, decimal commas");
  const Table commented = Read("# bench\n#t;p1\n" + rows);
  EXPECT_EQ(commented.columns[0].name, "#t");
  EXPECT_THAT(commented.columns[1].values, ElementsAre(12.25, 13.5, 14));
}

// Tests a row of units: its units go to the columns, and names that only look like units stay names.
TEST_F(CsvLayoutTest, UnitsRow) {
  const Table table = Read("t;p1\n[ms];Bar\n0;12,25\n0,5;13,5\n1;14\n");
  ExpectTheTable(table, "semicolons between cells, decimal commas, a row of units");
  EXPECT_EQ(table.columns[0].unit, "ms");
  EXPECT_EQ(table.columns[1].unit, "bar");
  EXPECT_EQ(table.Place(0, "t"), Path("x.csv") + ": line 3, column t");
  EXPECT_EQ(Read("t,p1,u\ns,psi,\n0,1,2\n").columns[2].unit, "");
  const Table short_names = Read("s,V\n0,1\n");  // no row of units without names
  EXPECT_EQ(short_names.columns[1].name, "V");
  EXPECT_EQ(short_names.columns[1].unit, "");
}

// Tests that a row of which only some cells are units has to be settled.
TEST_F(CsvLayoutTest, PerhapsUnits) {
  const std::string text = "t,p1\ns,pressure\n0,12.25\n0.5,13.5\n1,14\n";
  EXPECT_THAT(ErrorOf(text), AllOf(HasSubstr(Path("x.csv") + ": line 2: found \"s,pressure\""),
                                   HasSubstr("set units_row = true or units_row = false")));
  ExpectTheTable(Read(text, {.units_row = true}), "a row of units");
  EXPECT_EQ(Read(text, {.units_row = false}).columns[1].name, "pressure");
}

// Tests that UTF-16 of either order is read like UTF-8, with characters of every length.
TEST_F(CsvLayoutTest, Utf16) {
  const std::string text = "t;p1\n0;12,25\n0,5;13,5\n1;14\n";
  for (const bool little : {true, false}) {
    std::string bytes = little ? "\xff\xfe" : "\xfe\xff";
    for (const char c : text) {
      if (!little) bytes += '\0';
      bytes += c;
      if (little) bytes += '\0';
    }
    ExpectTheTable(Read(bytes), "UTF-16, semicolons between cells, decimal commas");
    EXPECT_THAT(ErrorOf(bytes.substr(0, bytes.size() - 1)), HasSubstr("half a character"));
    EXPECT_THAT(ErrorOf(bytes.substr(2)), HasSubstr("without its byte order mark"));
  }
  ExpectTheTable(Read("\xef\xbb\xbft,p1\n0,12.25\n0.5,13.5\n1,14\n"), "");
  const std::string mixed(
      "\xff\xfe"
      "a\0\xb0\0\xac\x20\x3d\xd8\x00\xde\x00\xd8",
      14);
  EXPECT_EQ(FromUtf16(mixed, "x").value(), "a°€\xF0\x9F\x98\x80\xef\xbf\xbd");
  EXPECT_EQ(FromUtf16("t,p1\n", "x"), std::nullopt);
}

// Tests that what can be read in two ways is an error that says what to set.
TEST_F(CsvLayoutTest, Ambiguous) {
  EXPECT_THAT(ErrorOf("t;p1\n1;1,234\n2;2,345\n"),
              AllOf(HasSubstr(": line 2: found commas that may mark decimals or thousands"),
                    HasSubstr("set decimal = \",\" in the sidecar")));
  EXPECT_THAT(Read("t;p1\n1;1,234\n2;2,345\n", {.decimal = ','}).columns[1].values,
              ElementsAre(1.234, 2.345));
  EXPECT_THAT(Read("t;p1\n0,001;1,234\n2;2,345\n").columns[1].values, ElementsAre(1.234, 2.345));
  EXPECT_THAT(ErrorOf("t;p1\n1;1,5\n2;2.5\n"),
              AllOf(HasSubstr(": line 2: found a comma in a number"), HasSubstr("in line 3 a decimal point"),
                    HasSubstr("decimal = \".\"")));
  EXPECT_THAT(ErrorOf("t;p1\n1;1,5\n2;2.5\n", {.decimal = '.'}),
              HasSubstr(": line 2, column p1: found \"1,5\", allowed a number"));
  EXPECT_THAT(ErrorOf("t;p1\n1;1,5\n2;2.5\n", {.decimal = ','}),
              HasSubstr(": line 3, column p1: found \"2.5\", allowed a number"));
  EXPECT_THAT(ErrorOf("t;p1\n0;1.234,5\n"),
              HasSubstr("line 2, column p1: found \"1.234,5\", allowed a number"));
}

// Tests that numbers without names are told so, and that commas alone are read as ever.
TEST_F(CsvLayoutTest, NoNames) {
  EXPECT_THAT(ErrorOf("0;1\n1;2\n"), AllOf(HasSubstr(": line 1: found numbers without as many names"),
                                           HasSubstr("set separator and skip_lines")));
  EXPECT_THAT(ErrorOf("time (s) p1 (bar)\n0 1\n1 2\n"), HasSubstr("put quotes around names with blanks"));
  EXPECT_EQ(Read("0,1\n1,2\n").columns[0].name, "0");
}

// Tests that what is stated wins.
TEST_F(CsvLayoutTest, Stated) {
  const std::string two = "a;b\n7;8\nt;p1\n0;12.25\n0.5;13.5\n1;14\n";
  EXPECT_THAT(ErrorOf(two), HasSubstr("line 3, column a: found \"t\""));
  ExpectTheTable(Read(two, {.skip_lines = 2}), "semicolons between cells, names after line 2");
  EXPECT_THAT(ErrorOf("t;p1\n0;1\n", {.separator = ','}), HasSubstr("line 2, column t;p1: found \"0;1\""));
  ExpectTheTable(Read("t p1\n0 12,25\n0,5 13,5\n1 14\n", {.separator = ' ', .decimal = ',', .skip_lines = 0}),
                 "blanks between cells, decimal commas");
  EXPECT_THAT(ErrorOf("t,p1\n", {.units_row = true}), HasSubstr("found no row of units"));
}

// Tests that cells are missing values between all separators, and that a separator at every line's end leaves
// no column.
TEST_F(CsvLayoutTest, EmptyCells) {
  const Table tabs = Read("t\tp1\tp2\n0\t\t3\n1\t2\t\n\t2\t3\n");
  EXPECT_TRUE(std::isnan(tabs.columns[1].values[0]));
  EXPECT_TRUE(std::isnan(tabs.columns[2].values[1]));
  EXPECT_TRUE(std::isnan(tabs.columns[0].values[2]));
  ExpectTheTable(Read("t;p1;\n0;12,25;\n0,5;13,5;\n1;14;\n"), "semicolons between cells, decimal commas");
  EXPECT_THAT(ErrorOf("t;p1;\n0;1;\n1;2;3\n"),
              HasSubstr("line 3, column : found \"3\", allowed an empty cell"));
  EXPECT_THAT(ErrorOf("t;p1\n0;1\nOL;2\n"), HasSubstr("line 3, column t: found \"OL\""));
}

// Tests that a table whose names say its units takes no row of units.
TEST_F(CsvLayoutTest, WithoutUnits) {
  log::WriteBytes(Path("x.csv"), "time_s,p1_psi\ns,bar\n0,1\n");
  EXPECT_THAT(log::InputErrorOf([&] { ReadTableWithoutUnits(Path("x.csv")); }),
              HasSubstr("column time_s: found the unit \"s\" in a row of units"));
  log::WriteBytes(Path("x.csv"), "time_s;p1_psi\n0;1\n");
  EXPECT_EQ(ReadTableWithoutUnits(Path("x.csv")).layout, "semicolons between cells");
}

// Tests the cells of rows of units: spellings of one meaning only.
TEST(UnitCellsTest, Spellings) {
  EXPECT_EQ(UnitOfCell(" [ °/s ] "), "deg/s");
  EXPECT_EQ(UnitOfCell("(PSI)"), "psi");
  EXPECT_EQ(UnitOfCell("U/min"), "rpm");
  EXPECT_EQ(UnitOfCell("µs"), "us");
  EXPECT_EQ(UnitOfCell("mPa"), "mPa");  // not MPa
  for (const char* cell : {"s", "bar", "[anything]", "A", "psig", "%", "N m/rad"})
    EXPECT_TRUE(IsUnitCell(cell));
  for (const char* cell : {"time", "p1", "mPa", "", "motor speed"}) EXPECT_FALSE(IsUnitCell(cell)) << cell;
}

// Tests numbers with decimal commas, and what is none.
TEST(CsvCellsTest, DecimalCommas) {
  EXPECT_EQ(ParseDecimalComma("-0,5"), -0.5);
  EXPECT_EQ(ParseDecimalComma("1,5e-3"), 1.5e-3);
  for (const char* text : {"1.5", "1", "1,2,3", "1.234,5", ",", "a,b", ""}) {
    EXPECT_EQ(ParseDecimalComma(text), std::nullopt) << text;
  }
  EXPECT_EQ(ParseDecimalComma(std::string(100, '0') + ",5"), std::nullopt);
  EXPECT_EQ(WithoutEnd("\t1\t\r", '\t'), "\t1\t");
  EXPECT_EQ(WithoutEnd("\t1\t\r", ';'), "1");
  EXPECT_EQ(WithoutByteOrderMark("\xef\xbb\xbf"
                                 "a"),
            "a");
  std::vector<std::string_view> cells;
  SplitCells("  \"a b\"  c\t d ", ' ', cells);
  EXPECT_THAT(cells, ElementsAre("a b", "c", "d"));
}

}  // namespace
}  // namespace hydro::tables
