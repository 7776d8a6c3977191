#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the effect's f and the base parameter f are one term.
TEST(PressureFriction, IsThePapersF) {
  model::ModelDescription base = Table1Model();
  base.parameters.f = 0.002;
  model::Actuator a(base, Held(model::Shaft::kClamped));
  model::Actuator b(Table1Model({{"pump.pressure_friction", {{"f", 0.002}}, {}}}),
                    Held(model::Shaft::kClamped));
  model::Actuator without(Table1Model(), Held(model::Shaft::kClamped));
  for (model::Actuator* actuator : {&a, &b, &without}) actuator->Advance(2.5, 0.2);
  EXPECT_NEAR(a.Measure().p2, b.Measure().p2, 1e-6);
  EXPECT_LT(a.Measure().p2, without.Measure().p2 - 10);
}

}  // namespace
}  // namespace hydro::testing
