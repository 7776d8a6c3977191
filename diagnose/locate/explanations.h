// The variables that may explain a balance's disturbance: the states, the command, or late sensors.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/locate/dependence.h"
#include "diagnose/locate/disturbance_smoother.h"

namespace hydro::diagnose {

class Explanations {
 public:
  // Keeps references to both. `units` are those of the model.
  Explanations(const std::vector<SmoothedRun>& smoothed, const std::vector<const RunData*>& runs,
               const UnitSystem& units)
      : smoothed_(smoothed), runs_(runs), units_(units) {}

  // Candidates for a missing term of the balance itself, simple variables first. `quick`: include those that
  // repeat within a turn.
  std::vector<Variable> States(Balance balance, bool quick) const;
  // The voltage, its excess over several limits, and its difference from itself after several lags.
  std::vector<Variable> Commands() const;
  // The effect of late readings on a balance: the rates of the signals that drive it.
  std::vector<Variable> Lateness(Balance balance) const;

 private:
  // `unit` is the paper's, `arm` the power of the arm's coordinate in it.
  template <class F>
  Variable Make(const std::string& name, const std::string& unit, const F& f, int arm = 0) const;
  // The phase of a wave that repeats `periods` times in a turn of the motor.
  Variable Turn(int periods) const;
  // Such a wave in proportion to the speed or the pressure difference.
  Variable Ripple(Balance balance, int periods) const;

  const std::vector<SmoothedRun>& smoothed_;
  const std::vector<const RunData*>& runs_;
  UnitSystem units_;
};

}  // namespace hydro::diagnose
