// How far an error of a run's start is carried on.
#include "diagnose/say/error_growth.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

// A run of a motor with a weight, which hangs or stands when it begins, under a small torque.
diagnose::RunData WithAWeight(const model::ModelDescription& model) {
  NoisyRig rig;
  rig.model = model;
  return rig.Record("weight", model::Shaft::kClamped, 0, 2, true, [](double) { return 0.1; });
}

model::ModelDescription Weight(double phase) {
  model::ModelDescription model = Table1With({{"load.gravity", {{"mgl", 6}, {"phase", phase}}, {}}});
  model.parameters.T_s = 0;
  return model;
}

// Tests that a weight that stands multiplies the error of its start, and that one that hangs, friction and an
// axis that integrates do not.
TEST(ErrorGrowth, OfWhatStandsAndWhatHangs) {
  const model::ModelDescription hangs = Weight(0), stands = Weight(std::numbers::pi), plain = Table1With();
  const diagnose::RunData hanging = WithAWeight(hangs), standing = WithAWeight(stands),
                          turning = SmallRun(plain, model::Shaft::kClamped, true, 2, 0, 1);
  EXPECT_GT(diagnose::ErrorGrowth(stands, {&standing}, 1), 10);
  EXPECT_LT(diagnose::ErrorGrowth(hangs, {&hanging}, 1), 1.1);
  EXPECT_LT(diagnose::ErrorGrowth(plain, {&turning}, 1), 1.1);
  // The worst run counts, and no run at all shows no growth.
  const double alone = diagnose::ErrorGrowth(stands, {&standing}, 1);
  EXPECT_GE(diagnose::ErrorGrowth(stands, {&turning, &standing}, 2), alone);
  EXPECT_EQ(diagnose::ErrorGrowth(stands, {}, 1), 1);
}

}  // namespace
}  // namespace hydro::testing
