// A spring at a hydraulic arm; at a bare motor's shaft: bare_motor_test.cc.
#include <gtest/gtest.h>

#include <vector>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

model::ModelDescription Sprung() {
  return Table1Model({{"load.spring", {{"stiffness", 500}, {"rest", 0.1}}, {}}});
}

// The arm's rate of speed, and the torque that loads the motor, at alpha = 0.3 and equal pressures.
struct Loads {
  double arm = 0, motor = 0;
};
Loads LoadsOf(model::Shaft shaft, bool bypass) {
  model::ActuatorOptions options = Held(shaft);
  options.bypass = bypass;
  options.arm_angle = 0.3;
  const model::Equations equations(Sprung(), options);
  std::vector<double> state = {0.2, 0, 300, 300};
  if (shaft == model::Shaft::kFree) state.insert(state.end(), {0.3, 0});
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, state, rate);
  return {shaft == model::Shaft::kFree ? rate[model::kArmSpeed] * 23.3 : 0, x.load};
}

// Tests that the spring acts at one place only: the free arm, with the bypass open as well; else the shaft of
// a motor whose bypass is open; and nowhere while something holds the arm against the oil.
TEST(LoadSpring, ActsWhereTheLoadIs) {
  for (const bool bypass : {false, true}) {
    const Loads free = LoadsOf(model::Shaft::kFree, bypass);
    EXPECT_NEAR(free.arm, -500 * (0.3 - 0.1), 1e-9) << bypass;
    EXPECT_EQ(free.motor, 0) << bypass;
  }
  EXPECT_EQ(LoadsOf(model::Shaft::kClamped, false).motor, 0);
  EXPECT_NEAR(LoadsOf(model::Shaft::kClamped, true).motor, 500 * (0.2 - 0.1), 1e-12);
}

// Tests that the numbers are those of the arm's coordinate where it is a length: force per length, length.
TEST(LoadSpring, HasTheArmsUnits) {
  const UnitSystem cylinder = {"m", "N", true};
  const std::vector<model::ParameterInfo>& numbers = model::FindEffect("load.spring")->parameters;
  EXPECT_EQ(numbers[0].UnitIn(cylinder), "N/m");
  EXPECT_EQ(numbers[1].UnitIn(cylinder), "m");
  EXPECT_EQ(numbers[0].UnitIn({}), "in-lbf/rad");
  EXPECT_EQ(numbers[1].UnitIn({}), "rad");
}

}  // namespace
}  // namespace hydro::testing
