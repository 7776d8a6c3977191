// What a scan of the balances proposes: a set of changes with all numbers estimated, for proof by exact
// simulation.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

struct Proposal {
  // Effects added or values freed, relative to the model as given. Empty: only other values of `base`, or no
  // change.
  std::vector<Change> changes;
  // The given model with those effects, and with all base values as estimated from all fitted runs.
  model::ModelDescription model;
  // Base parameters (BaseParameters()) whose values the estimate has moved. A refinement may move these too.
  std::vector<size_t> base;
  std::map<size_t, double> deviation;  // how surely each of these is known (EstimatedModel)
  // When runs are held out in turn: the same model estimated without each of the context's runs, in their
  // order. Empty: `model` predicts all runs, although it has seen them.
  std::vector<model::ModelDescription> without;
  double score = 0;   // log evidence + log prior
  double weight = 0;  // among all that were estimated, 0 to 1
};

// What the balances say of effects, by their ids.
struct SaidByBalances {
  std::map<std::string, double> weights;  // the total weight of all explanations with the effect
  std::vector<std::string> unlikely;      // effects that the balances rule out
};

}  // namespace hydro::diagnose
