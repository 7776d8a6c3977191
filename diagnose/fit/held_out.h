// How well a fitted hypothesis predicts runs that it was not fitted to.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// The logarithm of a squared gap, of one that is kept finite: what typical gaps are means of.
double LogarithmOf(double squared_gap);

struct HeldOut {
  double sum = 0;
  size_t count = 0;
  // By run: the predicted start, the model that did not see the run, and its squared gap.
  std::vector<model::StartState> starts;
  std::vector<model::ModelDescription> models;
  std::vector<double> gaps;

  double squared_gap() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
  // The geometric mean of the runs' squared gaps: what it says of windows does not hang on the worst few, and a
  // model that halves every window's gap counts the same at any distance from the noise.
  double typical_squared_gap() const;
};

// Predicts runs that the fit has not seen; only their starts are fitted.
HeldOut Predict(const Fitted& fitted, const std::vector<const RunData*>& held_out, int jobs);

// Holds out each of the fit's runs in turn: estimates the parameters from the others (parameters that these
// cannot determine are drawn to the values of `given`, and to effects of zero size) and predicts the run with
// them. The estimate is a Gauss-Newton step from the common fit, or a separate fit when that step predicts
// the run badly.
HeldOut PredictInTurn(const Fitted& fitted, const model::ModelDescription& given,
                      const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
