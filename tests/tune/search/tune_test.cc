#include "tune/search/tune.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

#include "base/text_file.h"
#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"
#include "tests/settings/texts.h"
#include "tune/search/gains.h"
#include "tune/search/simulated_step.h"

namespace hydro::tune {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRetuned = std::string(HYDRO_CONFIG) + "/retuned.toml";

struct Outcome {
  int code = -1;
  std::string out, err;
};

class TuneProgram : public settings::FolderTest {
 protected:
  Outcome Run(const std::string& program, const std::string& arguments) const {
    const std::string out = (folder_ / "out").string();
    const std::string err = (folder_ / "err").string();
    const int status = std::system((program + " " + arguments + " >" + out + " 2>" + err).c_str());
    return {WEXITSTATUS(status), ReadTextFile(out), ReadTextFile(err)};
  }
};

// Tests the whole program: it writes a configuration that keeps the given one's text but for the gains,
// loads, runs, and settles its step in the time that the table says.
TEST_F(TuneProgram, WritesAConfigurationThatDoesWhatItsTableSays) {
  const std::string tuned = (folder_ / "deep" / "tuned.toml").string();
  std::filesystem::create_directories(folder_ / "deep");
  const std::string report = (folder_ / "report").string();
  const Outcome outcome = Run(
      HYDRO_TUNE, kRetuned + " --goal step_rad=0.1 --samples 1 --jobs 2 -o " + tuned + " --out " + report);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("as configured: pressure loop 150 rad/s"));
  EXPECT_THAT(outcome.out, HasSubstr("eq. (17) alone: "));
  EXPECT_THAT(outcome.err, HasSubstr("hydro-tune: 100 %"));
  EXPECT_THAT(ReadTextFile(report + "/tune.html"), HasSubstr("<svg"));
  EXPECT_THAT(ReadTextFile(report + "/tune.html"), HasSubstr("\n  position ")) << "a table keeps its lines";
  EXPECT_THAT(ReadTextFile(report + "/tune.svg"), HasSubstr("bang-bang bound"));

  const std::string text = ReadTextFile(tuned);
  EXPECT_THAT(text, HasSubstr("# psi s/rad"));
  EXPECT_THAT(text, HasSubstr("natural_frequency_rad_s = 150.0  # Figure 8\n"))
      << "what does not change stays";
  const settings::StackConfig config = settings::LoadStackConfig(tuned);
  EXPECT_NE(config.position.c1, 10000);
  EXPECT_TRUE(config.position.braking_rad_s2.has_value());
  EXPECT_EQ(config.model.description.name, "Table 1");

  const StepJudge judge(config, {.goals = {.step = 0.1}, .samples = 0});
  const StepResult step = SimulateStep(config, judge.Nominal(0.1));
  ASSERT_TRUE(step.settled);
  char row[100];
  std::snprintf(row, sizeof row, "%.2f", step.ratio);
  const size_t at = outcome.out.find("\n       0.1 ");
  ASSERT_NE(at, std::string::npos) << outcome.out;
  const std::string line = outcome.out.substr(at + 1, outcome.out.find('\n', at + 1) - at - 1);
  EXPECT_THAT(line.substr(line.rfind('|')), HasSubstr(row));
  EXPECT_LT(step.ratio, 1.1);
  EXPECT_EQ(Run(HYDRO_SIM, tuned).code, 0);
}

// Tests that what is written says what it is: each changed value has its unit and what it was, no comment of
// the former value is left beside it, the first line names the gains, and a second search replaces it.
TEST_F(TuneProgram, WritesCommentsThatFollowWhatIsWritten) {
  const std::string given =
      Write("given.toml",
            settings::Replaced(
                settings::Replaced(ReadTextFile(kRetuned), "c2 = 900.0                    # psi s/rad",
                                   "c2 = 900.0  # the best of all"),
                "models/table1.toml", std::string(HYDRO_CONFIG) + "/models/table1.toml"));
  const std::string tuned = (folder_ / "tuned.toml").string(), again = (folder_ / "again.toml").string();
  const std::string how = " --fixed-gains --goal step=0.1 --samples 0 --set pressure.damping_ratio=0.6 -o ";
  ASSERT_EQ(Run(HYDRO_TUNE, given + how + tuned).code, 0);
  const std::string text = ReadTextFile(tuned);
  EXPECT_THAT(text, ::testing::StartsWith(
                        "# Gains by hydro-tune --goal step=0.1, from given.toml: position.c1 and "
                        "position.c2. Comments that speak of these were written for other values.\n"));
  EXPECT_THAT(text, Not(HasSubstr("the best of all")));
  EXPECT_THAT(text, ::testing::ContainsRegex("\nc2 = [0-9.]+ +# psi s/rad, by hydro-tune, was 900"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\nc1 = [0-9.]+ +# psi/rad, by hydro-tune, was 10000"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\ndamping_ratio = 0.6 +# by --set, was 0.5"));
  EXPECT_THAT(text, HasSubstr("natural_frequency_rad_s = 150.0  # Figure 8\n"));
  ASSERT_EQ(Run(HYDRO_TUNE, tuned + " --fixed-gains --goal step=0.2 --samples 0 -o " + again).code, 0);
  const std::string second = ReadTextFile(again);
  EXPECT_THAT(second, ::testing::StartsWith("# Gains by hydro-tune --goal step=0.2, from tuned.toml: "));
  EXPECT_EQ(second.find("# Gains by", 1), std::string::npos);
}

// Tests that gains that are the best of all are not replaced by others, and that this is said with nothing
// written: what the search found, tuned for again.
TEST_F(TuneProgram, KeepsWhatItCannotBetter) {
  const std::string tuned = (folder_ / "tuned.toml").string(), again = (folder_ / "again.toml").string();
  const std::string report = (folder_ / "report").string(), how = " --goal step=0.1 --samples 0 --jobs 2 -o ";
  ASSERT_EQ(Run(HYDRO_TUNE, kRetuned + how + tuned).code, 0);
  const Outcome outcome = Run(HYDRO_TUNE, tuned + how + again + " --fixed-gains --out " + report);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("tuned.toml: no proposal: nothing better than the configured gains"));
  EXPECT_THAT(outcome.out, HasSubstr("best found, not proposed: "));
  EXPECT_FALSE(std::filesystem::exists(again));
  EXPECT_FALSE(std::filesystem::exists(report));
}

// The ratios in the row "over the travel", of what is configured and of the last column.
std::pair<double, double> OverTheTravel(const std::string& out) {
  std::istringstream row(out.substr(out.find("over the travel") + 15));
  std::vector<double> ratios;
  for (std::string word; row >> word && word != "uncertain";) {
    if (word != "|") ratios.push_back(word[0] == '>' || word == "stops" ? HUGE_VAL : std::stod(word));
  }
  return {ratios.front(), ratios.back()};
}

// Tests that of every shipped configuration, the proposed gains settle every step that was tried, and are at
// least as good as the configured ones by the tool's own measure; or that it proposes none.
class ShippedStacks : public TuneProgram, public ::testing::WithParamInterface<const char*> {};

TEST_P(ShippedStacks, GetNoWorseGains) {
  const std::string tuned = (folder_ / "tuned.toml").string();
  const Outcome outcome =
      Run(HYDRO_TUNE, std::string(HYDRO_CONFIG) + "/" + GetParam() + " --samples 0 -o " + tuned);
  const auto [configured, proposed] = OverTheTravel(outcome.out);
  EXPECT_EQ(std::filesystem::exists(tuned), outcome.code == 0);
  if (outcome.code == 0) {
    EXPECT_THAT(outcome.out, HasSubstr("\nproposed: "));
    EXPECT_LE(proposed, configured) << outcome.out;
    EXPECT_TRUE(std::isfinite(proposed)) << outcome.out;
  } else {
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("no proposal: "));
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedStacks,
                         ::testing::Values("paper.toml", "demo.toml", "demo_si.toml", "front_end.toml",
                                           "retuned.toml", "differential_cylinder.toml",
                                           "limb.toml --joint knee"),
                         [](const auto& stack) {
                           std::string name = stack.param;
                           return name.substr(0, name.find('.'));
                         });

// Tests the stack under eq. (17) alone: no key of the curve is written.
TEST_F(TuneProgram, KeepsToFixedGainsWhenAsked) {
  const std::string tuned = (folder_ / "tuned.toml").string();
  const Outcome outcome =
      Run(HYDRO_TUNE, kRetuned + " --fixed-gains --goal step_rad=0.1 --samples 0 -o " + tuned);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, Not(HasSubstr("eq. (17) alone")));
  EXPECT_FALSE(settings::LoadStackConfig(tuned).position.braking_rad_s2);
}

// Tests that --set changes a key for the search, and that what is written has it, in its place, with paths
// that lead to the same files.
TEST_F(TuneProgram, SetsKeys) {
  const std::string tuned = (folder_ / "tuned.toml").string();
  const Outcome outcome = Run(
      HYDRO_TUNE, kRetuned +
                      " --fixed-gains --goal step_rad=0.1 --samples 0 --set pressure.damping_ratio=0.8 --set "
                      "model.file=models/table1_gravity.toml --set limits.return_s=0.25 -o " +
                      tuned);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const settings::StackConfig config = settings::LoadStackConfig(tuned);
  EXPECT_EQ(config.limits.return_s, 0.25);
  EXPECT_THAT(config.model.resolved_file, HasSubstr("table1_gravity.toml"));
  EXPECT_THAT(ReadTextFile(tuned), HasSubstr("# psi s/rad"));
  const Outcome wrong = Run(HYDRO_TUNE, kRetuned + " --set limits.retrun_s=0.25");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("limits.retrun_s"));
}

// Tests that - is the standard output, that all else then goes to the standard error, and that the advice
// names a file.
TEST_F(TuneProgram, WritesToTheStandardOutput) {
  const Outcome outcome = Run("cd " HYDRO_CONFIG " && " HYDRO_TUNE,
                              kRetuned + " --fixed-gains --goal step_rad=0.1 --samples 0 -o -");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(std::string(HYDRO_CONFIG) + "/-"));
  EXPECT_EQ(settings::ParseToml(outcome.out, "out").Find("model")->Find("file")->text, "models/table1.toml");
  EXPECT_THAT(outcome.out, HasSubstr("# psi s/rad"));
  EXPECT_THAT(outcome.err, HasSubstr("as configured: pressure loop 150 rad/s"));
  EXPECT_THAT(outcome.err, HasSubstr("next: hydro-sim TUNED.toml -o tuned.lcmlog"));
}

TEST_F(TuneProgram, RefusesGoalsWithTheLimitAndWritesNothing) {
  const std::string tuned = (folder_ / "tuned.toml").string();
  const Outcome outcome = Run(HYDRO_TUNE, kRetuned + " --goal settling_s=0.2 -o " + tuned);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(
      outcome.err,
      HasSubstr("T_pmax = 40 in-lbf moves the arm by 0.1 rad, and to within 2 % of it, in 0.3302 s at best"));
  EXPECT_FALSE(std::filesystem::exists(tuned));
}

TEST_F(TuneProgram, AnswersWrongInputWithOneLine) {
  const std::string same =
      Write("same.toml", settings::Replaced(ReadTextFile(kRetuned), "models/table1.toml",
                                            std::string(HYDRO_CONFIG) + "/models/table1.toml"));
  const std::string inline_table =
      Write("inline.toml", "model = { file = \"" + std::string(HYDRO_CONFIG) +
                               "/models/table1.toml\" }\n"
                               "pressure = { natural_frequency_rad_s = 150, damping_ratio = 0.5 }\n"
                               "position = { c1 = 1000, c2 = 100 }\n[reference]\nsignal = "
                               "\"arm_angle\"\nkind = \"steps\"\nsteps = []\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {kRetuned + " --goal speed=3", "--goal: found \"speed=3\""},
      {kRetuned + " --jobs 0", "--jobs: found 0, allowed 1 to 64"},
      {kRetuned + " --samples 101", "--samples: found 101"},
      {kRetuned + " --interval x", "--interval: found \"x\""},
      {kRetuned + " --interval -1", "--interval: found \"-1\", allowed a number of seconds above 0"},
      {kRetuned + " --interval nan", "--interval: found \"nan\""},
      {kRetuned + " --out /proc/none/deep",
       "--out: found \"/proc/none/deep\", a folder that cannot be written"},
      {kRetuned + " --out " + kRetuned + "/report", "a folder that cannot be written"},
      {kRetuned + " --interval 0.00013", "sample_interval_s"},
      {same + " -o " + same, "same.toml"},
      {inline_table + " -o " + (folder_ / "o.toml").string(), "a line of its own"},
      {(folder_ / "missing.toml").string(), "missing.toml"},
      {"", "CONFIG"}};
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = Run(HYDRO_TUNE, arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(expected)) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(ReadTextFile(same).find("10000.0") == std::string::npos, false) << "the input is as it was";
}

TEST_F(TuneProgram, TunesOnlyLoopsOfTheArmsAngle) {
  const std::string text = settings::Replaced(ReadTextFile(kRetuned), "models/table1.toml",
                                              std::string(HYDRO_CONFIG) + "/models/table1.toml");
  const std::string torque = Write("torque.toml", settings::Replaced(text, "\"arm_angle\"", "\"torque\""));
  EXPECT_THAT(Run(HYDRO_TUNE, torque).err,
              HasSubstr("reference.signal: found another signal, allowed \"arm_angle\""));
  const std::string clamped = Write("clamped.toml", settings::Replaced(text, "\"free\"", "\"clamped\""));
  const Outcome outcome = Run(HYDRO_TUNE, clamped);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("model.shaft"));
}

}  // namespace
}  // namespace hydro::tune
