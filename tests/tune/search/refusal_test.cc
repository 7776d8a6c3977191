#include "tune/search/refusal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tune/search/configs.h"

namespace hydro::tune {
namespace {

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

// Tests T_s/(k_1 k_p c_1), without the reference's feed-forward beside k_p.
TEST(Refusal, KnowsWhatFrictionLeaves) {
  const settings::StackConfig config = Retuned({"pressure.reference_feedforward=false"});
  EXPECT_NEAR(FrictionError(config, GainsOf(config)), 4 / (4 * 0.1336 * 1e4), 1e-6);
}

}  // namespace
}  // namespace hydro::tune
