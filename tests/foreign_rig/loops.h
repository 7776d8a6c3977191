// The experimenter's controllers, at the recorder's rate.
#pragma once

#include "plan.h"

namespace foreign_rig {

class Loops {
 public:
  Loops(const Plan& plan, const Values& values, double rate);

  // The command of the sample at t, from what the sensors say.
  double Volts(double t, const Reading& read);

 private:
  const Plan& plan_;
  double speed_gain_;      // V/(rad/s)
  double pressure_gain_;   // V/psi
  double damping_;         // V/(rad/s)
  double position_gain_;   // 1/s
  double friction_volts_;  // feed-forward
  double ratio_;           // motor turns per arm turn
  double feed_forward_;    // V/psi
  size_t at_ = 0;
};

}  // namespace foreign_rig
