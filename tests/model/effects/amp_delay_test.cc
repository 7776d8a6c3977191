#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that a delayed command acts exactly `delay` later, even when several are under way.
TEST(AmpDelay, ShiftsTheCommand) {
  for (const model::Integrator integrator : kIntegrators) {
    model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped, integrator));
    model::Actuator delayed(Table1Model({{"amp.delay", {{"delay", 7.7e-4}}, {}}}),
                            Held(model::Shaft::kClamped, integrator));
    delayed.Advance(0.5, 2e-4);  // below friction
    plain.Advance(0, 9.7e-4);
    for (int tick = 0; tick < 300; ++tick) {
      const double voltage = 2.6 + std::sin(tick);
      delayed.Advance(voltage, 2e-4 * (tick + 2));
      plain.Advance(voltage, 9.7e-4 + 2e-4 * (tick + 1));
    }
    delayed.Advance(0, plain.time());
    EXPECT_NEAR(delayed.Measure().p2, plain.Measure().p2, 1e-4) << Name(integrator);
    EXPECT_NEAR(delayed.Measure().motor_speed, plain.Measure().motor_speed, 1e-6) << Name(integrator);
    EXPECT_GT(delayed.Measure().p2, 110);
  }
}

}  // namespace
}  // namespace hydro::testing
