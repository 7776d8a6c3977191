// Fits a hypothesis to runs by simulation: chooses the free numbers and each run's start so that predicted
// and measured signals differ as little as possible, in noise units.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

struct RunFit {
  model::StartState start{};
  double sum = 0;    // of squared residuals
  size_t count = 0;  // of residuals
  // At the fitted values, with the unknown start eliminated (its best value follows the parameters):
  // information and gradient of sum/2 with respect to the free parameters as fitted (some as logarithms), by
  // columns.
  std::vector<double> information, gradient;
};

struct Fitted {
  std::string failure;  // why there is no fit; "" when there is one
  Hypothesis hypothesis;
  std::vector<RunFit> runs;
  double sum = 0;
  size_t count = 0;

  bool ok() const { return failure.empty(); }
  double squared_gap() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

// Each run's start, as fitted.
std::vector<model::StartState> StartsOf(const Fitted& fitted);

struct FitOptions {
  int most_iterations = 20;
  double tolerance = 1e-4;  // the fit stops when the sum falls by less than this, relative
  int jobs = 1;
  // Whether each step is followed by a line search where some number has a bound. It takes as many
  // derivatives again. Without it, a step that meets a bound ends there.
  bool line_search = true;
  bool at_turn = false;  // whether the starts are at the model's turn already (AtBestTurn())
};

// `starts` has an initial guess for each run. Fit() never throws ModelError: it reports a model that cannot
// be simulated as a failure.
Fitted Fit(const Hypothesis& hypothesis, const std::vector<const RunData*>& runs,
           const std::vector<model::StartState>& starts, const FitOptions& options);

}  // namespace hydro::diagnose
