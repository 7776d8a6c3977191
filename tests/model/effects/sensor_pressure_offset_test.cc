#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that offsets affect measurements and not the motion.
TEST(PressureOffset, ShiftsTheMeasurementOnly) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({{"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}}),
                       Held(model::Shaft::kClamped));
  plain.Advance(2.5, 0.2);
  with.Advance(2.5, 0.2);
  EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 + 3, 1e-6);
  EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 - 2, 1e-6);
}

}  // namespace
}  // namespace hydro::testing
