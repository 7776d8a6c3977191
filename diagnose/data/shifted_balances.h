// How well the torque and flow balances of a recording close when its clocks are shifted.
#pragma once

#include <Eigen/Core>

#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// Signals on an even grid, all smoothed a little in the same way, so that balances still hold.
struct EvenSignals {
  double step = 0;  // s
  Eigen::VectorXd voltage, speed, acceleration, p1, p2, p1_rate, p2_rate, arm_speed;
};

EvenSignals MakeEven(const runs::MeasuredRun& run, const model::Parameters& model);

// The balances as regressions: what the best coefficients leave open, as mean square over the target's
// variance; infinity where there are too few samples. Shifts are in steps of the grid.
class ShiftedBalances {
 public:
  ShiftedBalances(EvenSignals signals, const model::Parameters& model);

  // No shift exceeds this.
  int reach() const { return reach_; }
  Eigen::Index begin() const { return reach_ + 2; }
  Eigen::Index end() const { return signals_.speed.size() - reach_ - 2; }

  // What the torque balance leaves open with command and speed shifted by this many steps.
  double Torque(int command, int speed, Eigen::Index first, Eigen::Index last) const;

  // What the flow balance leaves open with the motor's and the arm's speed shifted by this many steps.
  double Flow(int speed, int arm, Eigen::Index first, Eigen::Index last) const;

 private:
  EvenSignals signals_;
  double floor_;
  int reach_ = 0;
  double slowest_ = 0, lowest_ = 0;
};

}  // namespace hydro::diagnose
