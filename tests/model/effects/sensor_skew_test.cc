#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that a channel gives its reading of `delay` earlier, and its first value before that: through
// switches and jumps of the voltage, and between ticks.
TEST(Skew, ReadsWhatWasThen) {
  const double delay = 3.1e-3;
  const auto advance = [](model::Actuator* actuator, double until) {  // a voltage that jumps every 2 ms
    for (int block = static_cast<int>(std::floor(actuator->time() / 2e-3 + 1e-6));; ++block) {
      actuator->Advance(2.5 + 3 * std::sin(2 * block), std::min(until, (block + 1) * 2e-3));
      if ((block + 1) * 2e-3 >= until) return;
    }
  };
  for (const model::Integrator integrator : kIntegrators) {
    for (const std::string name : {"p2", "motor_speed", "arm_angle"}) {
      model::Actuator plain(Table1Model(), Held(model::Shaft::kFree, integrator));
      model::Actuator late(Table1Model({{"sensor.skew", {{"delay", delay}}, {{"signal", name}}}}),
                           Held(model::Shaft::kFree, integrator));
      double highest = 0;
      for (int tick = 1; tick <= 1000; ++tick) {
        advance(&late, tick * 2e-4);
        const double then = tick * 2e-4 - delay;
        highest = std::max(highest, late.Measure().p2);
        if (then > 0) advance(&plain, then);
        const model::Measurement m = late.Measure(), expected = plain.Measure();
        if (name == "p2") {
          ASSERT_NEAR(m.p2, expected.p2, 1e-4) << Name(integrator) << " " << tick;
        } else if (name == "motor_speed") {
          ASSERT_NEAR(m.motor_speed, expected.motor_speed, 1e-4) << Name(integrator) << " " << tick;
        } else {
          ASSERT_NEAR(m.arm_angle, expected.arm_angle, 1e-8) << Name(integrator) << " " << tick;
          ASSERT_NEAR(m.arm_speed, expected.arm_speed, 1e-6) << Name(integrator) << " " << tick;
        }
      }
      EXPECT_GT(highest, 105);
    }
  }
}

}  // namespace
}  // namespace hydro::testing
