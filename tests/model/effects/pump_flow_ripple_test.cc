#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the pumped volume is D (theta + amplitude/periods sin(periods theta)), and that the pump's
// torque has the same ripple.
TEST(FlowRipple, PumpsTheVolumeOfItsAngle) {
  const double a = 0.1, n = 9;
  Rig rig(Sealed({"pump.flow_ripple", {{"amplitude", a}, {"periods", n}}, {}}), HeldAt(1000));
  for (int i = 1; i <= 20; ++i) {
    rig.simulation->Advance(2.5, 0.005 * i);
    const model::Measurement m = rig.Measure();
    const double volume = 0.00796 * (m.motor_angle + a / n * std::sin(n * m.motor_angle));
    EXPECT_NEAR(m.p2 - 1000, kStiffness * volume, 1e-4);
    EXPECT_NEAR(m.p1 - 1000, -kStiffness * volume, 1e-4);
    const model::Terms<double> x = TermsOf(rig, 2.5);
    const double D = 0.00796 * (1 + a * std::cos(n * m.motor_angle));
    EXPECT_NEAR(x.net_torque, 10 - D * (m.p2 - m.p1), 1e-9);
  }
  EXPECT_GT(rig.Measure().motor_angle, 0.7);  // a whole period
}

}  // namespace
}  // namespace hydro::testing
