#include "tune/search/refusal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tune/search/configs.h"
#include "tune/search/unsettled.h"

namespace hydro::tune {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Refused(const Goals& goals, const std::vector<std::string>& overrides = {},
                    const model::ModelDescription& model = experiments::ShippedModel("table1")) {
  return RefusalByTheMotor(StepJudge(Retuned(overrides, model), {.goals = goals}), goals);
}

TEST(Refusal, NamesTheMotorsTorqueAndWhatItCanDo) {
  EXPECT_THAT(
      Refused({.settling_s = 0.2}),
      HasSubstr("settling_s=0.2: the motor's torque T_pmax = 40 in-lbf moves the arm by 0.1 rad, and to "
                "within 2 % of it, in 0.3302 s at best"));
  EXPECT_EQ(Refused({.settling_s = 0.34}), "");
  EXPECT_THAT(Refused({.settling_s = 0.1, .step = 0.4}, {"limits.motor_speed=200"}),
              HasSubstr("limits.motor_speed = 200 rad/s and"));
}

TEST(Refusal, NamesSamplingTravelAndFriction) {
  EXPECT_THAT(Refused({.bandwidth_hz = 100}), HasSubstr("sampled every 0.005 s"));
  EXPECT_THAT(Refused({.step = 1}), HasSubstr("at most step=0.686"));
  model::ModelDescription stuck = experiments::ShippedModel("table1");
  stuck.parameters.T_s = 41;
  EXPECT_THAT(Refused({}, {}, stuck),
              HasSubstr("T_s = 41 in-lbf is not below the motor's torque T_pmax = 40 in-lbf"));
}

TEST(Refusal, NamesWhatTheBestGainsReach) {
  const StepJudge judge(Retuned(), {.samples = 0});
  SearchResult result;
  EXPECT_THAT(RefusalBySearch(judge, {}, result), HasSubstr("no gains of the position loop"));
  result.found = true;
  result.best = TryGains(judge, GainsOf(judge.config()));
  EXPECT_EQ(RefusalBySearch(judge, {}, result), "");
  EXPECT_THAT(RefusalBySearch(judge, {.bandwidth_hz = 30}, result),
              HasSubstr("the position loop reaches 2.51 Hz"));
  EXPECT_THAT(RefusalBySearch(judge, {.settling_s = 0.335}, result), HasSubstr("take 0.34"));
  EXPECT_THAT(RefusalBySearch(judge, {.overshoot_percent = 1}, result),
              HasSubstr("overshoot by at least 19"));
}

// Gains with these ratios of the steps, with and without the model's uncertainty.
Tried Rated(double ratio, double uncertain_ratio, double gain_margin) {
  Tried tried;
  tried.gains = GainsOf(Retuned());
  tried.steps.ratio = ratio;
  tried.steps.uncertain_ratio = uncertain_ratio;
  tried.steps.unsettled = ratio >= kNeverSettled ? 0.1 : 0;
  tried.steps.slowest.step = 0.3;
  design::CheckedLoop loop;
  loop.worst.stable = true;
  loop.worst.gain = gain_margin;
  loop.worst.phase_deg = 40;
  tried.check.pressure = tried.check.position = loop;
  return tried;
}

// Tests that only gains are proposed with which the arm settles, and that are better than the configured
// ones: sooner where no goal is given, whatever the margins, and else with wider margins.
TEST(Refusal, ProposesNothingThatIsNoBetter) {
  const StepJudge judge(Retuned(), {.samples = 0});
  const auto refused = [&](const Goals& goals, const Tried& best, const Tried& configured) {
    return RefusalToPropose(judge, goals, best, configured);
  };
  EXPECT_EQ(refused({}, Rated(1.2, 1.3, 2), Rated(1.4, 1.5, 4)), "");
  EXPECT_EQ(refused({}, Rated(1.2, 1.3, 2), Rated(kNeverSettled + 0.1, kNeverSettled + 0.1, 2)), "");
  EXPECT_THAT(
      refused({}, Rated(1.4, 1.5, 2), Rated(1.2, 1.3, 4)),
      HasSubstr("no proposal: nothing better than the configured gains was found, which settle within "
                "1.2 times the shortest time (with what may be true instead of the model: settle within "
                "1.3 times the shortest time) and have a gain margin of 4 and a phase margin of 40 deg"));
  EXPECT_THAT(refused({}, Rated(1.2, 1.3, 2), Rated(1.2, 1.3, 2)), HasSubstr("no proposal"));
  EXPECT_THAT(refused({}, Rated(1.4, 1.5, 2), Rated(1.2, 1.3, 1.1)),
              HasSubstr("with a --goal that is enough"));
  const Tried never = Rated(kNeverSettled, kNeverSettled, 3);
  EXPECT_THAT(
      refused({}, never, Rated(kNeverSettled + 0.5, kNeverSettled + 0.5, 3)),
      AllOf(HasSubstr(
                "no proposal: with no gains that keep the margins does the arm settle within 2.5 times "
                "the shortest time after every step tried, with the best of them not after one of 0.3 rad "
                "from 0 rad ("),
            HasSubstr("); the configured gains never settle")));
  // With a goal of settling time, margins decide.
  const Goals goals = {.settling_s = 1};
  EXPECT_EQ(refused(goals, Rated(1.4, 1.5, 5), Rated(1.2, 1.3, 4)), "");
  EXPECT_THAT(refused(goals, Rated(1.2, 1.3, 3), Rated(1.4, 1.5, 4)), HasSubstr("they meet the goals"));
  EXPECT_EQ(refused(goals, Rated(1.4, 1.5, 2), Rated(1.2, 1.3, 1.1)), "");
}

// Tests that the limit is named that keeps the arm from settling: each in a stack in which it does, and of
// gains that swing, that none is.
TEST(Refusal, NamesWhatKeepsTheArmFromSettling) {
  const auto why = [](const std::vector<std::string>& overrides) {
    const settings::StackConfig config = Retuned(overrides);
    const StepJudge judge(config, {.samples = 0});
    return WhyUnsettled(judge, GainsOf(config), judge.Nominal(0.1));
  };
  EXPECT_EQ(why({}), "");
  EXPECT_THAT(why({"limits.arm_torque=8"}), HasSubstr("limits.arm_torque 8 in-lbf holds it back "));
  EXPECT_THAT(why({"limits.pressure=130"}), HasSubstr("limits.pressure 130 psi ends the run, at "));
  EXPECT_THAT(why({"limits.motor_speed=100"}), HasSubstr("limits.motor_speed 100 rad/s ends the run, at "));
  EXPECT_THAT(why({"position.c1=10000", "position.c2=60"}),
              HasSubstr("the motor is at its torque T_pmax 40 in-lbf "));
  EXPECT_THAT(why({"position.c1=2000", "position.c2=300"}),
              HasSubstr("the pump's friction T_s holds the arm "));
  EXPECT_THAT(why({"position.c1=700", "position.c2=60"}),
              HasSubstr("no limit is reached for long: it is the gains"));
}

// Tests T_s/(k_1 k_p c_1), without the reference's feed-forward beside k_p.
TEST(Refusal, KnowsWhatFrictionLeaves) {
  const settings::StackConfig config = Retuned({"pressure.reference_feedforward=false"});
  EXPECT_NEAR(FrictionError(config, GainsOf(config)), 4 / (4 * 0.1336 * 1e4), 1e-6);
}

}  // namespace
}  // namespace hydro::tune
