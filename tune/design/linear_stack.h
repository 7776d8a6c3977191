// Both control laws around a linearised actuator as the stack samples them: exact from one period to the next.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "model/linearise.h"
#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::design {

struct StackTiming {
  double tick = 0;                        // s
  int command_delay = 1;                  // ticks from a sample to its effect, of both loops; 0 or 1
  int64_t pressure_interval = 1;          // ticks between samples of the pressure loop
  int64_t position_interval = 1;          // ticks between samples of the position loop
  double amplifier_delay = 0;             // s, by which the motor follows the voltage late (amp.delay)
  double late = 0;                        // s, by which the channels below are read late (sensor.skew)
  std::array<bool, 6> late_outputs = {};  // in the order of LinearModel's outputs
};

class LinearStack {
 public:
  // `position` null: the pressure loop alone, with a constant reference. States that nothing moves, and those on which
  // nothing depends, are left out. Throws std::domain_error, saying why, when the loop has too many samples in a
  // period, or delays of too many ticks, to be computed in time.
  LinearStack(const model::LinearModel& model, const StackTiming& timing,
              const pressure_ctrl::PressureLawSettings& pressure,
              const position_ctrl::PositionLawSettings* position);
  ~LinearStack();

  // s, until the pattern of samples repeats.
  double period() const;
  // Each loop is sampled once a period, so that its response is that of one loop with constant coefficients; else only the
  // poles tell about it.
  bool pressure_sampled_once() const;
  bool position_sampled_once() const;

  // Poles of the closed loop in the z plane, over one period. `voltage` multiplies what eq. (16) feeds back, `reference`
  // what eq. (17) does: 1 as it is, 0 opens the loop. All at infinity when the loop grows beyond all numbers within a period.
  std::vector<std::complex<double>> Poles(double voltage, double reference) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// Holds the arm's angle in the equations (not its speed): for a pressure loop that nobody asks where the arm drifts to.
// `actuator_angle`: the state of the actuator's own angle, the arm's unless something gives between them; -1: the
// model has no free arm.
void FreezeArmAngle(int actuator_angle, model::LinearModel* model);

}  // namespace hydro::design
