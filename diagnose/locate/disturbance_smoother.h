// What each balance of the model lacks along a measured run: an extended Kalman filter and a Bryson-Frazier
// smoother over the model's states and a wandering disturbance in each balance. The equations themselves
// smooth the signals, so nothing noisy is ever differentiated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "diagnose/data/run_data.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Eq. (4), torque on the pump; (13) and (14), flow into each side; (15), torque on the arm.
enum class Balance { kPumpTorque, kFlow1, kFlow2, kArmTorque };
inline constexpr size_t kBalances = 4;

// This many draws of pure noise go through the same filter. They show which disturbances are significant.
inline constexpr size_t kNoiseDraws = 6;

struct Disturbance {
  std::vector<double> value;                           // one a sample; in-lbf or in^3/s
  std::array<std::vector<double>, kNoiseDraws> noise;  // what the sensors' noise alone makes of it
  std::vector<uint8_t> informative;  // 0: friction at rest or an open valve hides the balance there
};

struct SmoothedRun {
  // Balances whose own quantity was measured; the others have no disturbance and are empty.
  std::array<bool, kBalances> measured{};
  std::array<Disturbance, kBalances> disturbance;
  std::vector<double> motor_angle, motor_speed, p1, p2, arm_angle, arm_speed;
};

// psi; subtracted from the measured pressures before use.
struct PressureOffsets {
  double p1 = 0, p2 = 0;
};

// Throws ModelError if the model contradicts the run's conditions. Time and memory grow with the number of
// samples; each needs about 3 kB while this runs.
SmoothedRun SmoothDisturbances(const model::ModelDescription& model, const RunData& run,
                               const PressureOffsets& offsets);

}  // namespace hydro::diagnose
