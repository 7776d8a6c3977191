// The model that a set of changes amounts to: the given one with the estimated values, and the effects at theirs.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

struct EstimatedModel {
  model::ModelDescription model;
  std::vector<Change> changes;  // effects, closures among them, and values that are far off
  std::vector<size_t> base;     // base parameters that the estimate moves, as in BaseParameters()
};

// `fit`: of `set`. A value keeps to its physical bounds. Empty where the set has a change that no model can state (oil that
// creeps).
std::optional<EstimatedModel> ModelOf(const ScanRuns& runs, const Rows& rows, const ChangeSet& set,
                                      const SetFit& fit);

}  // namespace hydro::diagnose
