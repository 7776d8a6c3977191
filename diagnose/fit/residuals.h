// A run's residuals relative to a model, in noise units, with their derivatives.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/recording/run_data.h"
#include "model/response.h"

namespace hydro::diagnose {

struct Residuals {
  // (Predicted - measured) / noise, one signal after the other, each signal's valid samples in order of time.
  std::vector<double> values;
  std::vector<double> jacobian;  // by columns, values.size() entries for each unknown
  std::vector<size_t> first;     // where each of the run's signals begins, then the end of the last
};

// Computes residuals and their derivatives with respect to the free parameters as a fit moves them (some as
// logarithms), then with respect to `starts`. The values of `free` are those of the model. Throws ModelError
// when the model cannot be simulated.
Residuals ResidualsOf(const model::ModelDescription& model, const RunData& run,
                      const model::StartState& start, const std::vector<FreeParameter>& free = {},
                      const std::vector<model::Unknown>& starts = {});

// The sum of the squared residuals; infinite where the model cannot be simulated.
double SumOfSquares(const model::ModelDescription& model, const RunData& run, const model::StartState& start);

// The unknown numbers of a run's start: those that are free, and those that the model's effects need in
// addition. The shaft's angle is unknown to effects that repeat with the shaft, except in the run whose zero
// counts, if the effect has a phase of its own. Waves may be under way in lines where a window begins. An
// accumulator that remembers what it has taken in may have taken in some before any run.
std::vector<model::Unknown> StartUnknowns(const model::ModelDescription& model, const RunData& run);
// Which of the unknowns is that angle; none where the angle is known.
std::optional<size_t> UnknownTurn(const model::ModelDescription& model, const RunData& run);

}  // namespace hydro::diagnose
