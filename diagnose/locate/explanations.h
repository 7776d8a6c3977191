// What a balance's disturbance may depend on, if it is the balance's own term, the command's or the sensors'.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/locate/dependence.h"
#include "diagnose/locate/disturbance_smoother.h"

namespace hydro::diagnose {

class Explanations {
 public:
  // Both are used as long as this is.
  Explanations(const std::vector<SmoothedRun>& smoothed, const std::vector<const RunData*>& runs)
      : smoothed_(smoothed), runs_(runs) {}

  // Of the balance's own terms; the plain ones come first. `quick`: also what repeats within a turn.
  std::vector<Variable> States(Balance balance, bool quick) const;
  // The voltage, how far it is beyond some value, and how far ahead of itself a time constant before.
  std::vector<Variable> Commands() const;
  // What readings that come late do to a balance: the rates of what it is driven by.
  std::vector<Variable> Lateness(Balance balance) const;

 private:
  template <class F>
  Variable Make(const std::string& name, const std::string& unit, const F& f) const;
  // What repeats with the motor's angle, so many times a turn.
  Variable Turn(int periods) const;
  // The same, in proportion to the speed or the pressure difference.
  Variable Ripple(Balance balance, int periods) const;

  const std::vector<SmoothedRun>& smoothed_;
  const std::vector<const RunData*>& runs_;
};

}  // namespace hydro::diagnose
