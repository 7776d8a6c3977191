// Both control laws around a linearised actuator, sampled as the stack samples them; exact from one period to
// the next.
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
  int command_delay = 1;                  // ticks from a sample to its effect, for both loops; 0 or 1
  int64_t pressure_interval = 1;          // ticks between samples of the pressure loop
  int64_t position_interval = 1;          // ticks between samples of the position loop
  double amplifier_delay = 0;             // s, lag of the motor behind the voltage (amp.delay)
  double late = 0;                        // s, delay of the channels below (sensor.skew)
  std::array<bool, 6> late_outputs = {};  // in the order of LinearModel's outputs
};

class LinearStack {
 public:
  // `position` null means the pressure loop alone, with a constant reference. States that do not change, and
  // states on which nothing depends, are left out. Throws std::domain_error, with the reason, when the loop
  // has too many samples in a period, or delays of too many ticks, to be computed in time.
  LinearStack(const model::LinearModel& model, const StackTiming& timing,
              const pressure_ctrl::PressureLawSettings& pressure,
              const position_ctrl::PositionLawSettings* position);
  ~LinearStack();

  // s, after which the pattern of samples repeats.
  double period() const;
  // Whether each loop is sampled once in a period. Its response is then that of one loop with constant
  // coefficients; otherwise only the poles describe it.
  bool pressure_sampled_once() const;
  bool position_sampled_once() const;

  // Poles of the closed loop in the z plane, over one period. `voltage` multiplies the feedback of eq. (16),
  // and `reference` that of eq. (17): 1 leaves it as it is, 0 opens the loop. All poles are at infinity when
  // the loop grows beyond all numbers within a period.
  std::vector<std::complex<double>> Poles(double voltage, double reference) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

// Holds the arm's angle in the equations (not its speed), for a pressure loop that is not responsible for the
// arm's drift. `actuator_angle` is the state of the actuator's own angle, which is the arm's unless something
// between them flexes; -1: the model has no free arm.
void FreezeArmAngle(int actuator_angle, model::LinearModel* model);

}  // namespace hydro::design
