// Tables of which only some columns are asked for, and what other programs write around the rows.
#include <gmock/gmock.h>

#include "base/tables/clock_text.h"
#include "base/tables/csv_cells.h"
#include "base/tables/table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::tables {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const AskedColumns kAsked{.names = {"t", "u"}, .time = "t", .date = ""};

class AskedColumnsTest : public log::LogTest {
 protected:
  Table Read(const std::string& text, const AskedColumns& asked = kAsked, const CsvSettings& settings = {}) {
    log::WriteBytes(Path("x.csv"), text);
    return ReadTable(Path("x.csv"), settings, asked);
  }
  std::string ErrorOf(const std::string& text, const AskedColumns& asked = kAsked,
                      const CsvSettings& settings = {}) {
    return log::InputErrorOf([&] { Read(text, asked, settings); });
  }
};

void ExpectTheTable(const Table& table) {
  ASSERT_EQ(table.columns.size(), 2u);
  EXPECT_THAT(table.Find("t")->values, ElementsAre(0, 0.5, 1));
  EXPECT_THAT(table.Find("u")->values, ElementsAre(7, 8, 9));
}

// Tests that other columns may hold anything, and have any names or none.
TEST_F(AskedColumnsTest, OthersAreNotJudged) {
  ExpectTheTable(Read(",t,u\n0,0,7\n1,0.5,8\n2,1,9\n"));
  ExpectTheTable(Read("A,t,A,u\nx,0,,7\n0x1F,0.5,-,8\n12:30,1,1e999,9\n"));
  ExpectTheTable(Read("t;note;u\n0;\"a; b\";7\n0,5;c.d, e;8\n1;1.234.567;9\n"));
  ExpectTheTable(Read("t,u,note\n0,7,\"two\nlines\"\n0.5,8,\"a \"\"b\"\"\"\n1,9,\n"));
  ExpectTheTable(Read("t , x , u\n0 , 1 , 7\n0.5 , 1 , 8\n1 , 1 , 9\n"));  // blanks separate nothing
  EXPECT_THAT(Read("t\n0\n1\n").names, ElementsAre("t"));                  // the same by every separator
  EXPECT_THAT(Read("A,t,A,u\n1,0,2,7\n").names, ElementsAre("A", "t", "A", "u"));
}

// Tests that those that are asked for are judged as ever.
TEST_F(AskedColumnsTest, AskedOnesAreJudged) {
  EXPECT_THAT(ErrorOf("t,u,t\n0,1,2\n"), HasSubstr("column 3: found the name \"t\" a second time"));
  EXPECT_THAT(ErrorOf("t,u,x\n0,1,2\n1,OL,2\n"),
              HasSubstr("line 3, column u: found \"OL\", allowed a number"));
  EXPECT_THAT(ErrorOf("x,t,u\n1,0,7\n2,1\n"), HasSubstr("line 3: found 2 cells, allowed 3"));
  EXPECT_TRUE(Read("x,y\n1,2\n").columns.empty());
  EXPECT_EQ(Read("t,y\n1,2\n").columns.size(), 1u);
}

// Tests that the names find the separator and the lines before and between, whatever those hold.
TEST_F(AskedColumnsTest, HeaderLines) {
  const Table three = Read("t;u;w\nms;V;rpm\n;drive;\n0;7;1\n0,5;8;1\n1;9;1\n");
  ExpectTheTable(three);
  EXPECT_EQ(three.Find("t")->unit, "ms");
  EXPECT_THAT(three.layout, HasSubstr("line 3 passed over, which is neither units nor numbers"));
  EXPECT_EQ(three.Place(0, "t"), Path("x.csv") + ": line 4, column t");
  ExpectTheTable(Read("t,u,w\nfloat,float,text\n\ns,V,\n---,---,---\n0,7,a\n0.5,8,b\n1,9,c\n"));
  ExpectTheTable(Read("t,u,w\n1,2,3\n0,7,a\n0.5,8,b\n1,9,c\n"));  // numbers of columns
  ExpectTheTable(Read("Recorder,7\n1,2\nt,u,w\n0,7,a\n0.5,8,b\n1,9,c\n"));
  EXPECT_THAT(Read("t,u\n1,2\n2,3\n").Find("t")->values, ElementsAre(1, 2));  // rows like any others
  EXPECT_THAT(ErrorOf("t,u,w\ns,pressure,\n0,7,a\n"), HasSubstr("of which only some are units"));
  EXPECT_THAT(ErrorOf("t,u,w\n"), HasSubstr("found no rows"));
  EXPECT_THAT(ErrorOf("t,u,w\ns,V,\n"), HasSubstr("found no rows"));
}

// Tests that numbers without names are told so, between commas too.
TEST_F(AskedColumnsTest, NoNames) {
  for (const char* text : {"0,1,2\n1,2,3\n", "0;1;2\n1;2;3\n", "0.1 5\n0.2 6\n"})
    EXPECT_THAT(ErrorOf(text), HasSubstr("line 1: found numbers without as many names in the line above"))
        << text;
}

// Tests RFC 4180's quotes: two of them are one, and separators and line feeds between them belong to the
// cell.
TEST_F(AskedColumnsTest, Quotes) {
  const AskedColumns asked{.names = {"t", "w, \"main\"", "two\nlines"}, .time = "t", .date = ""};
  const Table table = Read("t,\"w, \"\"main\"\"\",\"two\nlines\"\n0,1,2\n\"1\",\"3\",4\n", asked);
  ASSERT_EQ(table.columns.size(), 3u);
  EXPECT_THAT(table.Find("w, \"main\"")->values, ElementsAre(1, 3));
  EXPECT_THAT(table.Find("two\nlines")->values, ElementsAre(2, 4));
  EXPECT_EQ(table.Place(1, "t"), Path("x.csv") + ": line 4, column t");
  EXPECT_EQ(CellText("\"a \"\"b\"\"\""), "a \"b\"");
  EXPECT_EQ(CellText("\"\"\"\""), "\"");
  EXPECT_EQ(CellText("5\""), "5\"");
  EXPECT_EQ(EndOfLine("a,\"b\nc\",d\ne"), 9u);
  EXPECT_EQ(EndOfLine("pipe 5\", x\n\"y\n"), 10u);  // an inch, and a quote that is never closed
  std::vector<std::string_view> cells;
  SplitCells("\"a,\"\"b\",c", ',', cells);
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(CellText(cells[0]), "a,\"b");
}

// Tests that a text without a line end at its end is not taken for another number than was written.
TEST_F(AskedColumnsTest, CutInItsLastNumber) {
  const Table cut = Read("t,u\n0,17.25\n1,18.5\n2,1");
  EXPECT_THAT(cut.Find("u")->values, ElementsAre(17.25, 18.5));
  EXPECT_THAT(cut.layout, HasSubstr("the last line left out, 4, which has no end and is cut"));
  EXPECT_THAT(Read("t,u\n0,17.250\n1,18.500\n2,19.5").Find("u")->values, ElementsAre(17.25, 18.5));
  EXPECT_THAT(Read("t,u\n0,17\n1,18\n2").Find("u")->values, ElementsAre(17, 18));  // before its last cell
  const Table whole = Read("t,u\n0,17.250\n1,18.500\n2,19.500");
  EXPECT_THAT(whole.Find("u")->values, ElementsAre(17.25, 18.5, 19.5));
  EXPECT_EQ(whole.layout, "");
  const Table perhaps = Read("t,u\n0,17\n1,18\n2,19");
  EXPECT_THAT(perhaps.Find("u")->values, ElementsAre(17, 18, 19));
  EXPECT_THAT(perhaps.layout, HasSubstr("a last line, 4, without an end, whose last number may be cut"));
  EXPECT_EQ(Read("t,u,note\n0,17,abc\n1,18,a").layout, "");  // the cut is in what nobody asked for
  EXPECT_THAT(ErrorOf("t,u\n0"), HasSubstr("found no whole row, only line 2"));
}

// Tests that bytes of another encoding are told where they matter, and only there.
TEST_F(AskedColumnsTest, NotUtf8) {
  EXPECT_THAT(
      Read("t,w \xb0\n0,1\n").not_utf8,
      AllOf(HasSubstr("line 1: found byte 0xb0, which is not UTF-8"), HasSubstr("save the table as UTF-8")));
  ExpectTheTable(Read("t,u,w \xb0\n0,7,\xe4\n0.5,8,\n1,9,\n"));
  EXPECT_THAT(log::InputErrorOf([&] {
                log::WriteBytes(Path("y.csv"), "time_s,p \xe4\n0,1\n");
                ReadTable(Path("y.csv"));
              }),
              HasSubstr("found byte 0xe4"));
  EXPECT_THAT(ErrorOf("t,u\ns,\xb5V\n0,1\n"), HasSubstr("line 2: found byte 0xb5"));
}

// Tests times that are dates, times of day, or whole numbers that no double holds.
TEST_F(AskedColumnsTest, Times) {
  const Table iso =
      Read("t,u\n2026-01-01T10:30:25.000Z,7\n2026-01-01T10:30:25.500Z,8\n2026-01-01T12:30:26+02:00,9\n");
  ExpectTheTable(iso);
  EXPECT_EQ(iso.time_kind, TimeKind::kClock);
  ExpectTheTable(Read("t;u\n31.12.2025 23:59:59,5;7\n01.01.2026 00:00:00,0;8\n01.01.2026 00:00:00,5;9\n"));
  EXPECT_THAT(Read("t,u\n1767263425000000001,7\n1767263425000000003,8\n").Find("t")->values,
              ElementsAre(0, 2));
  const AskedColumns with_date{.names = {"t", "u", "day"}, .time = "t", .date = "day"};
  const Table dated =
      Read("day,t,u\n2026-01-01,23:59:59.5,7\n2026-01-02,00:00:00.0,8\n2026-01-02,00:00:00.5,9\n", with_date);
  ExpectTheTable(dated);
  EXPECT_EQ(Read("t,u\n10:00:00.25,7\n").Find("t")->values[0], 36000.25);
  EXPECT_THAT(ErrorOf("t,u\n1/2 10:30:25,7\n"),
              HasSubstr("allowed a number, or a date and a time like 2026-01-31T"));
  EXPECT_THAT(
      ErrorOf("t,u\n2026-01-01T10:30:25Z,7\n10:30:26,8\n"),
      HasSubstr("line 3, column t: found \"10:30:26\", allowed a time like the first, 2026-01-01T10:30:25Z"));
  EXPECT_THAT(ErrorOf("t,u\n0,2026-01-01T10:30:25Z\n"),
              HasSubstr("column u: found \"2026-01-01T10:30:25Z\""));
}

// Tests dates with slashes: a day above 12 in any row tells the order, of all rows, and one date alone needs
// none. What can be read in two ways, or in no one way, is refused, with the sidecar's line that settles it.
TEST_F(AskedColumnsTest, DatesWithSlashes) {
  ExpectTheTable(Read("t,u\n26/11/2026 23:59:59.5,7\n27/11/2026 00:00:00,8\n27/11/2026 00:00:00.5,9\n"));
  ExpectTheTable(Read("t,u\n11/30/2026 11:59:59.5 PM,7\n12/1/2026 12:00:00 AM,8\n12/1/2026 0:00:00.5,9\n"));
  // The row that tells comes late.
  EXPECT_THAT(Read("t,u\n12/11/2026 00:00:00,7\n13/11/2026 00:00:00,8\n").Find("t")->values,
              ElementsAre(0, 86400));
  EXPECT_THAT(Read("t,u\n1/12/2026 00:00:00,7\n1/13/2026 00:00:00,8\n").Find("t")->values,
              ElementsAre(0, 86400));
  ExpectTheTable(Read("t,u\n1/2/2026 10:30:25,7\n1/2/2026 10:30:25.5,8\n1/2/2026 10:30:26,9\n"));
  const std::string two_ways = "t,u\n\n1/2/2026 23:59:59.5,7\n2/2/2026 00:00:00,8\n2/2/2026 00:00:00.5,9\n";
  EXPECT_THAT(
      ErrorOf(two_ways),
      AllOf(HasSubstr("line 4, column t: found \"2/2/2026 00:00:00\", allowed dates of which one has a "
                      "day above 12, or time = { column = \"t\", date_order = \"dmy\" } in the sidecar "
                      "(\"mdy\" where the month comes first): these can be read in two ways")));
  AskedColumns stated = kAsked;
  stated.date_order = DateOrder::kDayFirst;
  ExpectTheTable(Read(two_ways, stated));
  stated.date_order = DateOrder::kMonthFirst;
  EXPECT_EQ(Read(two_ways, stated).Find("t")->values[1], 30 * 86400 + 0.5);  // from 2 January to 2 February
  EXPECT_THAT(ErrorOf("t,u\n13/1/2026 00:00:00,7\n1/14/2026 00:00:00,8\n"),
              HasSubstr("line 3, column t: found \"1/14/2026 00:00:00\", allowed dates in one order: "
                        "\"13/1/2026 00:00:00\" in line 2 has the day first"));
  const AskedColumns with_date{.names = {"t", "u", "day"}, .time = "t", .date = "day"};
  ExpectTheTable(
      Read("day,t,u\n30/11/2026,23:59:59.5,7\n1/12/2026,0:00:00,8\n1/12/2026,0:00:00.5,9\n", with_date));
  EXPECT_THAT(ErrorOf("day,t,u\n1/2/2026,23:59:59.5,7\n2/2/2026,0:00:00,8\n", with_date),
              HasSubstr("time = { column = \"t\", date = \"day\", date_order = \"dmy\" }"));
}

// Tests years of two digits, and dashes: what all rows together show in one way only is read, and of the rest
// the line of the sidecar that settles it is said.
TEST_F(AskedColumnsTest, DatesWithShortYears) {
  ExpectTheTable(Read("t,u\n30.11.26 23:59:59.5,7\n1.12.26 00:00:00,8\n01.12.26 00:00:00.5,9\n"));
  ExpectTheTable(Read("t,u\n26/11/26 10:30:25,7\n26/11/26 10:30:25.5,8\n26/11/26 10:30:26,9\n"));
  ExpectTheTable(Read("t,u\n11/30/26 23:59:59.5,7\n12/1/26 00:00:00,8\n12/1/26 00:00:00.5,9\n"));
  ExpectTheTable(Read("t,u\n30-11-2026 23:59:59.5,7\n1-12-2026 00:00:00,8\n1-12-2026 00:00:00.5,9\n"));
  const std::string three_ways = "t,u\n1-2-3 23:59:59.5,7\n1-2-4 00:00:00,8\n1-2-4 00:00:00.5,9\n";
  EXPECT_THAT(
      ErrorOf(three_ways),
      AllOf(HasSubstr("line 3, column t: found \"1-2-4 00:00:00\", allowed dates of which one has four "
                      "digits of the year and a day above 12, or time = { column = \"t\", date_order = "
                      "\"dmy\" } in the sidecar (\"mdy\" where the month comes first, \"ymd\" where the "
                      "year comes first): these can be read in three ways")));
  AskedColumns stated = kAsked;
  stated.date_order = DateOrder::kYearFirst;
  ExpectTheTable(Read(three_ways, stated));
  EXPECT_THAT(ErrorOf("t,u\n26/11/26 00:00:00,7\n27/11/26 00:00:00,8\n"),
              HasSubstr("(\"ymd\" where the year comes first): these can be read in two ways"));
  EXPECT_THAT(ErrorOf("t,u\n32/13/26 00:00:00,7\n"), HasSubstr("found \"32/13/26 00:00:00\""));
}

// Tests that of a date and a time in two columns, the one that is wrong is named, and that a column of dates
// alone is answered with the line that reads both.
TEST_F(AskedColumnsTest, DateAndTimeInTwoColumns) {
  const AskedColumns with_date{.names = {"t", "u", "day"}, .time = "t", .date = "day"};
  ExpectTheTable(
      Read("day,t,u\n30.11.26,23:59:59.5,7\n01.12.26,0:00:00,8\n1.12.26,0:00:00.5,9\n", with_date));
  EXPECT_THAT(ErrorOf("day,t,u\nMonday,23:59:59.5,7\n", with_date),
              HasSubstr("line 2, column day: found \"Monday\", allowed a date alone, like 2026-01-31"));
  EXPECT_THAT(ErrorOf("day,t,u\n2026-01-31,2026-01-31 23:59:59.5,7\n", with_date),
              AllOf(HasSubstr("line 2, column t: found \"2026-01-31 23:59:59.5\", allowed a time of day"),
                    HasSubstr("time = \"t\" in the sidecar")));
  for (const char* date : {"2026-01-31", "31.01.26", "31/1/26"}) {
    EXPECT_THAT(
        ErrorOf(std::string("t,u,clock\n") + date + ",7,10:30:25\n"),
        HasSubstr("allowed a time; the sidecar's line time = { column = \"clock\", date = \"t\" } reads "
                  "both columns"));
  }
}

// Tests what is a clock's text, and what is not.
TEST(ClockTextTest, Parses) {
  const auto seconds = [](const char* text) {
    return ParseClock(text).has_value() ? ParseClock(text)->seconds : -1;
  };
  EXPECT_EQ(seconds("1970-01-02T00:00:01Z"), 86401);
  EXPECT_EQ(seconds("1970/01/02 00:00:01+01:00"), 82801);
  EXPECT_EQ(seconds("02.01.1970 00:00:01"), 86401);
  EXPECT_EQ(seconds("10:30:25"), 37825);
  EXPECT_EQ(ParseClock("10:30:25.1234567891")->nanoseconds, 123456789);
  EXPECT_FALSE(ParseClock("2026-01-01")->time);
  EXPECT_EQ(seconds("12:30:00 AM"), 1800);
  EXPECT_EQ(seconds("12:30:00 pm"), 45000);
  EXPECT_EQ(seconds("3:30:25.5PM"), 55825);
  EXPECT_EQ(ParseClock("2/1/1970 00:00:01", DateOrder::kDayFirst)->seconds, 86401);
  EXPECT_EQ(ParseClock("1/2/1970 00:00:01", DateOrder::kMonthFirst)->seconds, 86401);
  EXPECT_FALSE(ParseClock("13/2/1970", DateOrder::kMonthFirst).has_value());
  for (const char* text : {"", "10:30", "2026-13-01", "2026-02-30T00:00:00", "01/02/2026", "24:00:00",
                           "10:30:25x", "2026", "13:00:00 PM", "0:00:00 AM"})
    EXPECT_FALSE(ParseClock(text).has_value()) << text;
}

}  // namespace
}  // namespace hydro::tables
