// The model that a set of changes amounts to: the given model with the estimated values and the estimated
// effects.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

struct EstimatedModel {
  model::ModelDescription model;
  std::vector<Change> changes;  // effects, including closures, and values that are far off
  std::vector<size_t> base;     // base parameters that the estimate moves, as in BaseParameters()
  // Of each of these: the standard deviation of its logarithm, or of the value where 0 was given.
  std::map<size_t, double> deviation;
};

// `fit` is the fit of `set`. Each value keeps to its physical bounds. The result is empty where the set has a
// change that no model can state (oil that creeps).
std::optional<EstimatedModel> ModelOf(const ScanRuns& runs, const Rows& rows, const ChangeSet& set,
                                      const SetFit& fit);

}  // namespace hydro::diagnose
