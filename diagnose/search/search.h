// The search for what a model lacks: effects and parameters are added while that predicts held-out runs
// materially better, then taken back and exchanged for others.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/comparison.h"
#include "diagnose/fit/fit.h"
#include "diagnose/fit/held_out.h"
#include "diagnose/search/progress.h"
#include "diagnose/search/scan.h"

namespace hydro::diagnose {

// A hypothesis with what is known of it.
struct Explanation {
  Fitted fitted;
  HeldOut held_out;
  BlockSums blocks;  // of held_out

  double squared_gap() const { return fitted.squared_gap(); }
  double held_out_gap() const { return held_out.squared_gap(); }
  const std::vector<Change>& changes() const { return fitted.hypothesis.changes; }
};

struct Rated {
  Change change;
  double expected = 0;  // fall of the squared gap that the score test of the given model expects
  std::string failure;  // of its simulation
};

// Everything that was tried, by what was added to the given model.
struct SearchResult {
  Explanation given;
  std::vector<Rated> rated;        // all single changes to the given model
  std::vector<Explanation> tried;  // all that were fitted, in the order of trying
  Explanation best;
};

struct SearchContext {
  model::ModelDescription given;
  std::vector<const RunData*> runs;
  std::vector<const RunData*> held_out;  // empty: the runs in turn
  std::vector<Change> changes;           // those that may be made
  Sizes sizes;
  int jobs = 1;
  TellProgress tell;
};

// Fits, and predicts the held-out runs, both with the options' jobs.
Explanation Explain(const SearchContext& context, const Hypothesis& hypothesis,
                    const std::vector<model::StartState>& starts, const FitOptions& options);

// The same begun once more from the measured starts, where its fit leaves a gap, and where that is left
// still, from each run's best (BestStarts); what fits best of these. Starts that were fitted while something
// was missing made up for it, and may hold the fit where friction or cogging catch the shaft at another
// place.
Explanation BegunAgain(const SearchContext& context, const Explanation& one, const FitOptions& options);

// From `from` on, a hypothesis without changes of its own.
SearchResult Search(const SearchContext& context, const Hypothesis& from, int most_changes);

}  // namespace hydro::diagnose
