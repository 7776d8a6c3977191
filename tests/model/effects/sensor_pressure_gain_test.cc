#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that a gain affects measurements only.
TEST(PressureGain, ScalesTheMeasurement) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({{"sensor.pressure_gain", {{"gain", 0.02}}, {}}}),
                       Held(model::Shaft::kClamped));
  plain.Advance(2.5, 0.2);
  with.Advance(2.5, 0.2);
  EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 * 1.02, 1e-6);
  EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 * 1.02, 1e-6);
}

}  // namespace
}  // namespace hydro::testing
