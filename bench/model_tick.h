// One 5 kHz tick of Table 1's actuator with its pressure loop, eq. (16), held between samples and following a
// +/-300 psi square wave of 10 Hz: what bench_model times, and what bench_sim's stacks are measured by.
#pragma once

#include "model/actuator.h"
#include "tests/table1.h"

namespace hydro::bench {

inline constexpr int kTicksPerSecond = 5000;

inline model::ModelDescription Table1Model() {
  model::ModelDescription model;
  model.name = "Table 1";
  model.parameters = testing::Table1();
  return model;
}

// V.
inline double PressureLoop(const model::Measurement& m, int tick) {
  const double reference = tick % 500 < 250 ? 300 : -300;
  return 0.134 * (reference - (m.p2 - m.p1) - 8.4 * m.motor_speed);
}

inline void AdvanceTick(model::Actuator& actuator, int tick) {
  actuator.Advance(PressureLoop(actuator.Measure(), tick), static_cast<double>(tick + 1) / kTicksPerSecond);
}

}  // namespace hydro::bench
