// How well a fitted hypothesis predicts runs that it was not fitted to.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// The logarithm of a squared gap, of one that is kept finite: what typical gaps are means of.
double LogarithmOf(double squared_gap);

struct HeldOut {
  size_t count = 0;          // of residuals
  std::vector<double> gaps;  // squared, by run

  // The geometric mean of the runs' squared gaps: what it says of windows does not hang on the worst few, and a
  // model that halves every window's gap counts the same at any distance from the noise.
  double typical_squared_gap() const;
};

// Predicts runs that the fit has not seen; only their starts are fitted.
HeldOut Predict(const Fitted& fitted, const std::vector<const RunData*>& held_out, int jobs);

}  // namespace hydro::diagnose
