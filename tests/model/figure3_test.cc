// Figure 3 of the paper: the clamped shaft after a step of T_p = 10 in-lbf from p1 = p2 = 100 psi.
#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

class Figure3 : public ::testing::TestWithParam<model::Integrator> {};

// Tests that peak, stick and second slip come at the times of an independent integration.
TEST_P(Figure3, PeakStickAndSlip) {
  Rig rig(Table1Model(), Held(model::Shaft::kClamped, GetParam()));
  double peak_p2 = 0, peak_dp = 0, peak_time = 0, stick_time = 0, slip_time = 0, slip_dp = 0;
  for (int i = 1; i <= 65000; ++i) {
    const double t = i * 2e-5;
    rig.simulation->Advance(10 / 4.0, t);
    const model::Measurement m = rig.Measure();
    if (m.p2 > peak_p2) {
      peak_p2 = m.p2;
      peak_time = t;
    }
    peak_dp = std::max(peak_dp, m.p2 - m.p1);
    const bool sticks = rig.simulation->mode().pump == 0;
    if (sticks && stick_time == 0) stick_time = t;
    if (!sticks && stick_time != 0 && slip_time == 0) {
      slip_time = t;
      slip_dp = m.p2 - m.p1;
    }
  }
  EXPECT_NEAR(peak_p2, 1512.6, 0.1);
  EXPECT_NEAR(peak_dp, 1412.6, 0.1);
  EXPECT_NEAR(peak_time, 0.2445, 1e-4);  // flat: within 0.002 psi from 0.244 to 0.245
  EXPECT_NEAR(stick_time, 0.252, 5e-4);
  EXPECT_NEAR(slip_time, 1.194, 5e-4);
  EXPECT_NEAR(slip_dp, 753.8, 0.1);
}

// Tests that the pump stands exactly still while it sticks.
TEST_P(Figure3, StickIsStill) {
  Rig rig(Table1Model(), Held(model::Shaft::kClamped, GetParam()));
  rig.simulation->Advance(2.5, 0.3);
  ASSERT_EQ(rig.simulation->mode().pump, 0);
  const model::Measurement before = rig.Measure();
  rig.simulation->Advance(2.5, 1.1);
  const model::Measurement after = rig.Measure();
  EXPECT_EQ(before.motor_speed, 0);
  EXPECT_EQ(after.motor_speed, 0);
  EXPECT_EQ(after.motor_angle, before.motor_angle);
}

INSTANTIATE_TEST_SUITE_P(Paths, Figure3, ::testing::ValuesIn(kIntegrators),
                         [](const auto& test) { return Name(test.param); });

}  // namespace
}  // namespace hydro::testing
