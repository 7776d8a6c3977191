#include "tune/design/fastest_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/settings/texts.h"

namespace hydro::design {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

settings::StackConfig With(double arm_inertia, double beta) {
  settings::StackConfig config = settings::Parsed(settings::kConfigText);
  config.model.description.parameters.J_a = arm_inertia;
  config.model.description.parameters.beta = beta;
  return config;
}

// Tests the arm between its two springs of fluid, where the pump is so heavy that it stands: 2 c^2 beta/V,
// eqs. (6) to (15).
TEST(FastestMotion, IsThatOfTheEquations) {
  settings::StackConfig config = With(1e-6, 2.47e5);
  config.limits.arm_angle_rad = 1e-6;  // mid-stroke only
  model::Parameters& p = config.model.description.parameters;
  p.J = 1e9;
  p.b = p.f = p.c_E = p.c_I = 0;
  EXPECT_NEAR(FastestMotion(config) / std::sqrt(2 * p.c * p.c * p.beta / (p.V_ms * p.J_a)), 1, 1e-3);
}

// Tests that what nobody can wait for is said, with the model's file and the parameters that it depends on;
// and that no shipped stack or model that is merely stiff has such a remark.
TEST(FastMotionRemark, SaysWhatTakesVeryLong) {
  EXPECT_EQ(FastMotionRemark(settings::Parsed(settings::kConfigText)), "");
  EXPECT_EQ(FastMotionRemark(With(23.3, 2.5e7)), "");
  EXPECT_THAT(FastMotionRemark(With(1e-8, 2.47e5)),
              AllOf(HasSubstr("model.toml: its fastest motion, "), HasSubstr("J_a"),
                    HasSubstr("in a tick of 0.001 s")));
}

// Tests that a machine which nothing can simulate is refused before the run, in one line that says what to
// check: an arm without mass, a weight and a spring beyond all others.
TEST(FastMotionRemark, RefusesWhatNoMachineDoes) {
  const auto refusal = [](const settings::StackConfig& config) {
    return settings::InputErrorOf([&] { FastMotionRemark(config); });
  };
  settings::StackConfig heavy = With(23.3, 2.47e5), sprung = heavy;
  heavy.model.description.parameters.mgl = 9.2e18;
  sprung.model.description.effects.push_back(
      {.id = "load.spring", .parameters = {{"stiffness", 1e18}, {"rest", 1}}, .names = {}});
  for (const settings::StackConfig& config : {With(1e-12, 2.47e5), heavy, sprung}) {
    EXPECT_THAT(refusal(config), AllOf(HasSubstr("model.toml: parameters and effects: found a machine that "
                                                 "oscillates at "),
                                       HasSubstr(" Hz, allowed up to 1e+07 Hz; check J_a, J, V_ms, beta"),
                                       Not(HasSubstr("\n"))));
  }
}

// Tests that a limb has the remarks of each joint's stack, with its name; under an [arm], whose loads are
// others, none of them holds.
TEST(RemarksOn, AreThoseOfEachJoint) {
  const settings::StackConfig fast = With(1e-8, 2.47e5);
  EXPECT_THAT(RemarksOn(fast), ::testing::ElementsAre(FastMotionRemark(fast)));
  EXPECT_TRUE(RemarksOn(With(23.3, 2.5e7)).empty());
  settings::LimbConfig limb;
  limb.joints = {{"hip", With(23.3, 2.5e7)}, {"knee", fast}};
  EXPECT_THAT(RemarksOn(limb), ::testing::ElementsAre("joint knee: " + FastMotionRemark(fast)));
  limb.arm.emplace();
  EXPECT_TRUE(RemarksOn(limb).empty());
}

}  // namespace
}  // namespace hydro::design
