#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the pump is where the line says: the actuator's pressure lags behind the pump's when flow
// starts.
TEST(LineWave, PumpSideMovesFirst) {
  Rig rig(Table1Model({Wave(300, 0.2, 0.05)}), Held(model::Shaft::kClamped));
  rig.simulation->Advance(10, 2e-4);
  const double* state = rig.simulation->now().state;
  EXPECT_GT(state[6] - 100, 2 * (state[model::kP2] - 100));
  EXPECT_GT(state[model::kP2], 100);
  EXPECT_EQ(rig.equations.StateNames()[6], "pump_p2");
}

}  // namespace
}  // namespace hydro::testing
