// What a scan of the balances proposes: a set of changes with all numbers estimated, for proof by exact
// simulation.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/evidence/estimated_model.h"

namespace hydro::diagnose {

// An estimated model that is to be proved. Without `changes`, only values of `base` differ from the given
// model, or nothing does. A refinement may move the values of `base` too.
struct Proposal : EstimatedModel {
  // When runs are held out in turn: the same model estimated without each of the context's runs, in their
  // order. Empty: `model` predicts all runs, although it has seen them.
  std::vector<model::ModelDescription> without;
  double score = 0;   // log evidence + log prior
  double weight = 0;  // among all that were estimated, 0 to 1
  // Names of parameters of which each model of `without` has its run's own value.
  std::vector<std::string> by_run = {};
};

// What the balances say of effects, by their ids.
struct SaidByBalances {
  std::map<std::string, double> weights;  // the total weight of all explanations with the effect
  std::vector<std::string> unlikely;      // effects that the balances rule out
};

}  // namespace hydro::diagnose
