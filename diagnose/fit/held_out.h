// How well a fitted hypothesis predicts runs that it was not fitted to.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

struct HeldOut {
  double sum = 0;
  size_t count = 0;
  // By run: the predicted start, and the model that did not see it.
  std::vector<model::StartState> starts;
  std::vector<model::ModelDescription> models;

  double squared_gap() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

// Predicts runs that the fit has not seen; only their starts are fitted.
HeldOut Predict(const Fitted& fitted, const std::vector<const RunData*>& held_out, int jobs);

// Each of the fit's runs in turn: what the others say of the parameters (with what they cannot tell drawn to
// the values of `given` and to effects of no size), and how well that predicts it. They are asked by a
// Gauss-Newton step from the common fit, and by a fit of their own when that step predicts the run badly.
HeldOut PredictInTurn(const Fitted& fitted, const model::ModelDescription& given,
                      const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
