#include "runs/exports/write_export.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>

#include "base/tables/table.h"
#include "runs/exports/mat_layout.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::exports {
namespace {

using definitions::FieldType;
using testing::HasSubstr;

// A run with a table and a channel that has every kind of column, with rows and without.
ExportedRun EveryKind(size_t rows) {
  ExportedRun run;
  run.name = "2 runs";
  run.files = {"run.lcmlog"};
  run.facts = {{"recorded_by", "hydro-sim"}};
  Sheet table;
  table.name = "table";
  table.is_table = true;
  table.topic = "/hydro/table";
  table.columns = {
      {{"time_s", FieldType::kDouble, "", "s", ""}, std::vector<double>{0, 0.5}},
      {{"p1_psi", FieldType::kDouble, "", "psi", ""}, std::vector<double>{std::nan(""), -1e300}}};
  table.time_s = {0, 0.5};
  table.received = table.published = table.order = {0, 1};
  Sheet channel;
  channel.name = "HYDRO_X";
  channel.topic = "/hydro/x";
  channel.constants = {{"ON", FieldType::kInt8, "1"}};
  channel.columns = {
      {{"on", FieldType::kBoolean}, std::vector<int64_t>{1, 0}},
      {{"n", FieldType::kInt32}, std::vector<int64_t>{-5, 2}},
      {{"long", FieldType::kInt64}, std::vector<int64_t>{INT64_MIN, INT64_MAX}},
      {{"text", FieldType::kString}, std::vector<std::string>{"", "\xe2\x98\x82 \"a\",\xff"}},
      {{"lists", FieldType::kInt64, "n"}, std::vector<std::vector<int64_t>>{{}, {1, 2}}},
      {{"numbers", FieldType::kDouble, "n"}, std::vector<std::vector<double>>{{0.5}, {}}},
      {{"names", FieldType::kString, "n"}, std::vector<std::vector<std::string>>{{"a", ""}, {}}}};
  channel.time_s = {0, 0.5};
  channel.received = channel.published = channel.order = {2, 3};
  KeepRows({rows > 0, rows > 1}, &channel);
  run.sheets = {table, channel};
  return run;
}

class WriteExportTest : public log::LogTest {};

// Tests that every format takes every kind of column, of one run and of several, with rows and without, and
// that the same runs give the same bytes.
TEST_F(WriteExportTest, EveryKindOfColumn) {
  for (const Format format : {Format::kMat, Format::kMat73, Format::kHdf5, Format::kMcap}) {
    for (const size_t rows : {0u, 2u}) {
      const std::vector<ExportedRun> one = {EveryKind(rows)};
      std::vector<ExportedRun> two = {EveryKind(rows), EveryKind(2)};
      two[1].name = "other";
      for (const auto& runs : {one, two}) {
        WriteExport(runs, format, "test", Path("a"));
        WriteExport(runs, format, "test", Path("b"));
        EXPECT_GT(log::ReadBytes(Path("a")).size(), 500u) << NameOf(format);
        EXPECT_EQ(log::ReadBytes(Path("a")), log::ReadBytes(Path("b"))) << NameOf(format);
      }
    }
  }
}

// Tests that a MAT file that does not fit is an error wherever it is cut, and leaves nothing: matio does not
// report its last buffer, and a channel's struct is most of the file.
TEST_F(WriteExportTest, NoRoomForAMatFile) {
  const std::vector<ExportedRun> runs = {EveryKind(2)};
  WriteExport(runs, Format::kMat, "test", Path("whole"));
  const size_t whole = log::ReadBytes(Path("whole")).size();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (size_t room = 200; room < whole; room += 200) {
    rlimit small = before;
    small.rlim_cur = room;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    bool failed = false;
    try {
      WriteExport(runs, Format::kMat, "test", Path("cut"));
    } catch (const WriteError&) {
      failed = true;
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_TRUE(failed) << room << " of " << whole;
    EXPECT_FALSE(std::filesystem::exists(Path("cut"))) << room;
  }
  std::signal(SIGXFSZ, handler);
}

// Tests that what was written is read by our own reader of MAT files, structs too.
TEST_F(WriteExportTest, MatIsRead) {
  for (const Format format : {Format::kMat, Format::kMat73}) {
    ExportedRun run = EveryKind(2);
    const std::string file = Path(std::string(NameOf(format)) + ".mat");
    WriteExport({run}, format, "test", file);
    const tables::Table table = tables::ReadTable(file);
    ASSERT_NE(table.Find("p1_psi"), nullptr);
    EXPECT_EQ(table.Find("p1_psi")->values[1], -1e300);
    ASSERT_NE(table.Find("HYDRO_X.n"), nullptr);
    EXPECT_EQ(table.Find("HYDRO_X.n")->values[0], -5);
    EXPECT_THAT(table.WhyNot("HYDRO_X.text"), HasSubstr("found text"));
  }
}

// Tests CSV: empty cells for what is missing, quotes, lists as words, units in a channel's names; and that it
// holds one table.
TEST_F(WriteExportTest, Csv) {
  ExportedRun run = EveryKind(2);
  EXPECT_THAT(log::InputErrorOf([&] { WriteExport({run}, Format::kCsv, "test", Path("x")); }),
              HasSubstr("found 2 tables to export (table, HYDRO_X), allowed is one in a file of CSV"));
  run.sheets.erase(run.sheets.begin());
  run.sheets[0].columns[1].field.unit = "rad/s";
  WriteExport({run, run}, Format::kCsv, "test", Path("x"));
  EXPECT_THAT(
      log::ReadBytes(Path("x")),
      testing::StartsWith("run,time_s,received_us,on,n_rad_s,long,text,lists,numbers,names\n"
                          "2 runs,0,2,1,-5,-9223372036854775808,,,0.5,a \n"
                          "2 runs,0.5,3,0,2,9223372036854775807,\"\xe2\x98\x82 \"\"a\"\",\xff\",1 2,,\n"
                          "2 runs,0,2,1,-5"));
}

// Tests that missing numbers can be written as nan, and that other cells stay as they are.
TEST_F(WriteExportTest, MissingAsNan) {
  ExportedRun run = EveryKind(2);
  run.sheets.erase(run.sheets.begin() + 1);
  WriteExport({run}, Format::kCsv, "test", Path("empty"));
  WriteExport({run}, Format::kCsv, "test", Path("nan"), Missing::kNan);
  const std::string empty = log::ReadBytes(Path("empty")), nan = log::ReadBytes(Path("nan"));
  EXPECT_NE(empty, nan);
  EXPECT_THAT(nan, HasSubstr("nan"));
  std::string without = nan;
  for (size_t at = without.find("nan"); at != std::string::npos; at = without.find("nan"))
    without.erase(at, 3);
  EXPECT_EQ(without, empty);
}

// Tests texts in UTF-16: beyond the first 65,536 letters, and bytes that are no UTF-8.
TEST(MatLayoutTest, Utf16) {
  EXPECT_EQ(Utf16("a\xc2\xb5\xe2\x98\x82"), u"aµ☂");
  EXPECT_EQ(Utf16("\xf0\x9d\x84\x9e"), u"\xd834\xdd1e");
  EXPECT_EQ(Utf16("\xff\xc2"), u"\xfffd\xfffd");
  EXPECT_EQ(Utf16("\xe2\x98"), u"\xfffd\xfffd");
}

// Tests that runs get names that MATLAB takes, each its own.
TEST(MatLayoutTest, Names) {
  const std::vector<MatField> variables = MatVariables({EveryKind(1), EveryKind(1)});
  EXPECT_EQ(variables[0].name, "run_2_runs");
  EXPECT_EQ(variables[1].name, "run_2_runs_2");
}

}  // namespace
}  // namespace hydro::exports
