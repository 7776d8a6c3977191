// What to do with a gap that no known effect explains: the missing torque or flow as a smooth curve of one
// variable, or a surface over two, in the model like any other effect. It names no cause, but the model predicts with it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/locate/locate.h"
#include "diagnose/search/explanation.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

struct ClosedModel {
  std::vector<Closure> closures;  // empty: nothing predicts held-out runs materially better
  model::ModelDescription model;  // with the closures
};

// The model that closures are added to: what was found, or its effects with other values of the model, as fitted to whole
// runs or to windows; that which predicts windows of the fitted runs best.
struct ClosureBase {
  const Explanation* explanation = nullptr;
  bool other_values = false;  // it is not what was found
};
ClosureBase BaseOfClosure(const SearchContext& context, const Explanation& best, const Explanation& refit,
                          const WindowTrials& trials);

// Starts from the tables of `possible` (Locate on the base's model), fits values to windows of the
// fitted runs, takes the one that predicts other windows of them best, and keeps it if windows of the held-out runs are
// predicted materially better. Where runs are held out in turn, it is judged by every other run, after a fit of the rest.
// The number of simulations is limited, not the time, so that a search that ran out of time may have a closure too.
ClosedModel FindClosure(const SearchContext& context, const ClosureBase& base,
                        const std::vector<PossibleTerm>& possible);

// Puts the closures and their model into the diagnosis, if there are any.
void AddClosures(ClosedModel closed, Diagnosis* diagnosis);
// What the verdict's sentence has to add; "" without closures.
std::string ClosureSentence(const std::vector<Closure>& closures);

}  // namespace hydro::diagnose
