#include <gmock/gmock.h>

#include "runs/measured/measured_run.h"
#include "runs/measured/sidecar.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr char kRest[] = "shaft = \"free\"\n[columns]\ntime = \"t\"\nvoltage = \"u\"\n";

class SidecarSearchTest : public log::LogTest {
 protected:
  void Write(const std::string& name, const std::string& text) { log::WriteBytes(Path(name.c_str()), text); }
  void WriteTable(const std::string& name) { Write(name, "t,u\n0,1\n1,2\n"); }
};

// Tests that one sidecar serves every table whose name fits its pattern, and that each keeps a name of its
// own.
TEST_F(SidecarSearchTest, OneForMany) {
  for (const char* name : {"run1.csv", "run2.csv", "other.csv"}) WriteTable(name);
  Write("bench.toml", "tables = \"run*.csv\"\n" + std::string(kRest));
  Write("model.toml", "name = \"a model, no sidecar\"\n");
  Write("broken.toml", "tables = \"run*.csv\n");
  EXPECT_EQ(FindSidecar(Path("run1.csv")).file, Path("bench.toml"));
  EXPECT_TRUE(FindSidecar(Path("run1.csv")).shared);
  EXPECT_EQ(ReadMeasuredRun(Path("run2.csv")).name, "run2");
  Write("bench.toml", "name = \"bench\"\ntables = \"run?.csv\"\n" + std::string(kRest));
  EXPECT_EQ(ReadMeasuredRun(Path("run2.csv")).name, "bench: run2");
  EXPECT_THAT(
      log::InputErrorOf([&] { ReadMeasuredRun(Path("other.csv")); }),
      AllOf(HasSubstr("found no " + Path("other.toml")), HasSubstr("`tables` is a pattern of its name")));
}

// Tests that a table's own sidecar wins, whatever patterns there are, and may have one for others.
TEST_F(SidecarSearchTest, OwnSidecarWins) {
  WriteTable("run1.csv");
  WriteTable("run2.csv");
  Write("all.toml", "tables = \"*.csv\"\nbypass = true\n" + std::string(kRest));
  Write("run1.toml", "name = \"first\"\ntables = \"nothing.csv\"\n" + std::string(kRest));
  EXPECT_EQ(ReadMeasuredRun(Path("run1.csv")).name, "first");
  EXPECT_FALSE(ReadMeasuredRun(Path("run1.csv")).bypass);
  EXPECT_TRUE(ReadMeasuredRun(Path("run2.csv")).bypass);
}

// Tests that two patterns that fit are an error with both files, and a pattern that is no text serves
// nothing.
TEST_F(SidecarSearchTest, TwoPatterns) {
  WriteTable("run1.csv");
  Write("a.toml", "tables = \"run*.csv\"\n" + std::string(kRest));
  Write("b.toml", "tables = \"*1.csv\"\n" + std::string(kRest));
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("run1.csv")); }),
              AllOf(HasSubstr("found 2 sidecars whose `tables` fit its name"), HasSubstr(Path("a.toml")),
                    HasSubstr(Path("b.toml")), HasSubstr("narrow a pattern, or write " + Path("run1.toml"))));
  Write("a.toml", "tables = 3\n" + std::string(kRest));
  EXPECT_EQ(FindSidecar(Path("run1.csv")).file, Path("b.toml"));
}

}  // namespace
}  // namespace hydro::runs
