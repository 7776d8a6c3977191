#include "batch/study/study.h"

#include "batch/study/case_inputs.h"
#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kConfig = std::string("config = \"") + HYDRO_CONFIG + "/demo.toml\"\n";
const std::string kStep = "[[step]]\nrun = [\"true\"]\n";

std::string Shown(const std::vector<Value>& values) {
  std::string text;
  for (const Value& value : values) text += (text.empty() ? "" : " ") + PlainText(value);
  return text;
}

// Tests that grid, list and draws are combined, and that the draws change fastest and the first factor of the
// grid slowest.
TEST(StudyTest, CombinesAllFactors) {
  const StudyFolder folder;
  const Study study = folder.Read(R"(
draws = 2
[[step]]
run = ["true", "{case}"]
[[grid]]
key = "a"
values = ["x", "y"]
[[grid]]
key = "b"
from = 1
to = 100
steps = 3
scale = "log"
[list]
keys = ["c", "d"]
rows = [[1, true], [2, false]]
)");
  ASSERT_EQ(study.cases(), 2 * 3 * 2 * 2);
  EXPECT_THAT(study.Keys(), ElementsAre("a", "b", "c", "d"));
  EXPECT_EQ(Shown(study.Values(0)), "x 1 1 true");
  EXPECT_EQ(Shown(study.Values(1)), "x 1 1 true");
  EXPECT_EQ(Shown(study.Values(2)), "x 1 2 false");
  EXPECT_EQ(Shown(study.Values(4)), "x 10 1 true");
  EXPECT_EQ(Shown(study.Values(23)), "y 100 2 false");
}

// Tests that evenly spaced values have no digits from rounding.
TEST(StudyTest, SpacesValuesEvenly) {
  const StudyFolder folder;
  const Study study = folder.Read(kStep + "[[grid]]\nkey = \"a\"\nfrom = 0\nto = 1\nsteps = 11\n");
  EXPECT_EQ(Shown(study.Values(3)), "0.3");
  EXPECT_EQ(Shown(study.Values(7)), "0.7");
  EXPECT_EQ(Shown(study.Values(10)), "1");
}

// Tests that the rows of a CSV file are cases, its names their keys.
TEST(StudyTest, ReadsRowsOfCsv) {
  const StudyFolder folder;
  folder.Write("rows.csv", "position.c1,trial\n3000,one\n6000.5,two\n");
  const Study study = folder.Read(kConfig + "[list]\nfile = \"rows.csv\"\n");
  ASSERT_EQ(study.cases(), 2);
  EXPECT_EQ(Shown(study.Values(1)), "6000.5 two");
  EXPECT_TRUE(study.files.contains("inputs/rows.csv"));
}

// Tests that a billion cases cost no more memory than one, as each is worked out from its number.
TEST(StudyTest, HoldsNoCases) {
  const StudyFolder folder;
  const Study study = folder.Read("draws = 1000000000\n" + kStep +
                                  "[[draw]]\nkey = \"a\"\ndistribution = \"uniform\"\nmin = 0\nmax = 1\n");
  EXPECT_EQ(study.cases(), 1'000'000'000);
  EXPECT_NE(Shown(study.Values(999'999'999)), Shown(study.Values(999'999'998)));
}

// Tests that wrong input is refused with its place, its key, what was found and what is allowed.
TEST(StudyTest, RefusesWrongInput) {
  const StudyFolder folder;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"nmae = \"x\"\n" + kStep, "study.toml:1: \"nmae\": found an unknown key"},
      {"", "study.toml:1: step: found nothing, allowed a command, or config for hydro-sim"},
      {kStep + "[[grid]]\nkey = \"a\"\n",
       "study.toml:3: grid.values: found nothing, allowed a list, or from, to and steps"},
      {kStep + "[[grid]]\nkey = \"a\"\nvalues = []\n", "study.toml:5: grid.values: found"},
      {kStep + "[[grid]]\nkey = \"a\"\nfrom = -1\nto = 1\nsteps = 3\nscale = \"log\"\n",
       "study.toml:8: grid.scale: found \"log\" from -1 to 1, allowed bounds above 0"},
      {kStep + "[[grid]]\nkey = \"a\"\nvalues = [1]\nsteps = 2\n",
       "study.toml:5: grid.values: found from, to or steps beside it"},
      {kStep + "[[grid]]\nkey = \"position.c1\"\nvalues = [1]\n",
       "study.toml:4: grid.key: found \"position.c1\", allowed a name without"},
      {kConfig + "[[grid]]\nkey = \"model:betta\"\nvalues = [1]\n",
       "study.toml:3: grid.key: found \"model:betta\", allowed model: and one of"},
      {kConfig + "[[grid]]\nkey = \"effect:pump.strbeck.speed\"\nvalues = [1]\n",
       "study.toml:3: grid.key: found"},
      {kStep + "[[draw]]\nkey = \"a\"\ndistribution = \"choice\"\nvalues = [1]\n",
       "study.toml:1: draws: found nothing, allowed how many to draw"},
      {"drws = 1\n" + kStep + "[[draw]]\nkey = \"a\"\ndistribution = \"choice\"\nvalues = [1]\n",
       "study.toml:1: \"drws\": found an unknown key"},
      {"draws = 1\n" + kStep +
           "[[grid]]\nkey = \"a\"\nvalues = [1]\n[[draw]]\nkey = \"a\"\ndistribution = \"choice\"\nvalues = "
           "[1]\n",
       "study.toml:8: a: found it twice"},
      {kStep + "[list]\nkeys = [\"a\", \"b\"]\nrows = [[1, 2], [3]]\n",
       "study.toml:5: list.rows: found row 2 with 1 values"},
      {"[[step]]\nrun = \"hydro-smi\"\n",
       "study.toml:2: step.run: found \"hydro-smi\", allowed \"hydro-sim\""},
      {"[[step]]\nrun = [\"true\"]\nexit_codes = [256]\n", "study.toml:3: step.exit_codes: found 256"},
      {kStep + "[collect]\nx = \"out.json\"\n",
       "study.toml:4: collect.x: found \"out.json\", allowed \"FILE:/POINTER\""},
      {kStep + "[collect]\nx = \"../out.json:/x\"\n",
       "study.toml:4: collect.x: found \"../out.json\", allowed a file in the case's folder"},
      {kStep + "[collect]\ncase = \"out.json:/x\"\n",
       "study.toml:4: collect.case: found \"case\", allowed a name that no other column has"},
      {"keep = [\"result.json\"]\n" + kStep, "study.toml:1: keep: found \"result.json\""},
      {kStep + "[report]\nworst = \"x\"\n", "study.toml:4: report.worst: found \"x\""},
      {"set = [\"a.b=1\"]\n" + kStep, "study.toml:1: set: found it without config"},
      {kConfig + "[[grid]]\nkey = \"position.c1\"\nvalues = [1000, -5]\n",
       "study.toml:3: position.c1 = -5: position.c1: found -5, allowed"},
      {kConfig + "[[grid]]\nkey = \"position.c9\"\nvalues = [1]\n",
       "study.toml:3: position.c9 = 1: position: \"c9\": found an unknown key"},
      {kConfig + "[list]\nkeys = [\"position.c1\", \"position.c9\"]\nrows = [[1000, 1]]\n",
       "study.toml:3: position.c9 = 1: position: \"c9\": found an unknown key"},
      {kConfig + "[list]\nkeys = [\"position.c8\", \"position.c9\"]\nrows = [[1000, 1]]\n",
       "study.toml: case 0 (position.c8 = 1000, position.c9 = 1): position: \"c8\": found"},
      {kConfig + "draws = 9\n[[draw]]\nkey = \"model:b\"\ndistribution = \"normal\"\nmean = 0.01\n"
                 "standard_deviation = 0.02\n",
       "study.toml:4: model:b = -"},
      {kConfig + "draws = 9\n[[draw]]\nkey = \"machine:betta\"\ndistribution = \"uncertainty\"\n",
       "study.toml:4: draw.key: found \"machine:betta\", allowed machine: and one of"},
      {kConfig + "[[grid]]\nkey = \"machine:pump.stribeck.sped\"\nvalues = [1]\n",
       "study.toml:3: grid.key: found \"machine:pump.stribeck.sped\", allowed machine:pump.stribeck. and one "
       "of "
       "\"static_excess\" or \"speed\", did you mean \"speed\"?"},
      {kStep + "[[grid]]\nkey = \"machine:b\"\nvalues = [1]\n",
       "study.toml:4: grid.key: found \"machine:b\", allowed machine: only in a study with a config"},
      {"draws = 5\n" + kStep, "study.toml:1: draws: found 5 and no section [[draw]]"},
      {kStep + "[[grid]]\nkey = \"a\"\nfrom = 1\nto = 2\n",
       "study.toml:3: grid.steps: found nothing, allowed all of from, to and steps"},
      {"config = \"none.toml\"\n", "study.toml:1: config: "},
      {"files = [\"none.py\"]\n" + kStep, "study.toml:1: files: "},
      {"config = \"" + std::string(HYDRO_CONFIG) + "/limb.toml\"\n",
       "study.toml:1: config: " + std::string(HYDRO_CONFIG) + "/limb.toml: found a limb, allowed a stack"},
      {kStep + "[[grid]]\nkey = \"a\"\nvalues = [1, 2]\n[collect]\nx = \"o.json:/x\"\n"
               "[report]\nsurface = [\"a\", \"b\", \"x\"]\n",
       "study.toml:9: report.surface: found \"b\", allowed two different keys that vary: \"a\""},
  };
  for (const auto& [text, line] : cases) EXPECT_THAT(folder.Refusal(text), StartsWith(line)) << text;
}

// Tests that one joint of a limb is a stack that a study may change.
TEST(StudyTest, TakesAJointOfALimb) {
  const StudyFolder folder;
  const Study study = folder.Read("config = \"" + std::string(HYDRO_CONFIG) +
                                  "/limb.toml\"\nset = [\"joint=knee\"]\n"
                                  "[[grid]]\nkey = \"position.c2\"\nvalues = [800, 900]\n");
  EXPECT_THAT(CaseInputs(study).Config(study.Values(1)), ::testing::HasSubstr("c2 = 900"));
}

// Tests that the name is that of the file, also of a study that is read from its folder.
TEST(StudyTest, IsCalledAsItsFile) {
  const StudyFolder folder;
  folder.Write("gains.toml", kStep);
  const Study study = ReadStudy(folder / "gains.toml");
  EXPECT_EQ(study.name, "gains");
  folder.Write("study.toml", study.files.at("study.toml"));
  EXPECT_EQ(ReadStudy(folder / "study.toml").name, "gains");
}

// Tests that the examples are studies.
TEST(StudyTest, ReadsTheExamples) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HYDRO_EXAMPLES "/studies")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_GT(ReadStudy(entry.path()).cases(), 10) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 2);
}

// Tests that a difference between two studies is told with its key, and that the report's wishes are none.
TEST(StudyTest, TellsTheFirstDifference) {
  const StudyFolder folder;
  const Study was = folder.Read(kShellStudy);
  EXPECT_EQ(
      StudyDifference(was, folder.Read("# a comment\n" + kShellStudy + "[report]\nworst = \"k_again\"\n")),
      "");
  EXPECT_EQ(StudyDifference(was, folder.Read("seed = 2\n" + kShellStudy)),
            "study.toml: seed: was absent, is 2");
  std::string other = kShellStudy;
  other.replace(other.find("[1, 2, 3]"), 9, "[1, 2, 4]");
  EXPECT_EQ(StudyDifference(was, folder.Read(other)), "study.toml: grid[0].values[2]: was 3, is 4");
}

// Tests that a change of the configuration that a study names is a difference.
TEST(StudyTest, SeesAnotherConfiguration) {
  const StudyFolder folder;
  const Study was = folder.Read(kConfig);
  EXPECT_EQ(StudyDifference(was, folder.Read(kConfig + "set = [\"position.c1=5000\"]\n")),
            "config.toml: position.c1: was 6000, is 5000");
}

}  // namespace
}  // namespace hydro::batch
