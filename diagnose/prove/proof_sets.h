// The sets of changes under proof, judged and refined on the same windows.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proof_windows.h"
#include "diagnose/prove/proposal.h"
#include "diagnose/prove/proved_set.h"

namespace hydro::diagnose {

class ProofSets {
 public:
  static constexpr size_t kGiven = 0;  // the place of the model as given
  enum class Values { kAsTheyAre, kRefined };

  // `allowed` has indices in BaseParameters() of the values that a refit may move. Keeps references to all
  // arguments.
  ProofSets(const ProofContext& context, const Hypothesis& as_given, const std::vector<size_t>& allowed,
            const SaidByBalances& said);

  // Adds the proposals, judged with their own values, and a refit if no proposal has other values alone.
  // Where proposed values cannot be simulated, the values of the given model replace them.
  void Add(const std::vector<Proposal>& proposals);
  // Sets the windows that are fitted from here on, with the discrepancy that the set at this place leaves.
  void SetFitted(size_t leading);
  // Sets with effects start from the values of the best set of values alone, where these suit their effects
  // better. Otherwise a set might lose only because nobody fitted its values.
  void BeginAtBestValues();
  // Refines the set by a few steps of a fit, once.
  void Refine(size_t place);
  // Adds a set with one more change, fitted from the catalogue's starts and judged.
  void Race(size_t from, const Change& change);
  // Tries each base value that may differ and that balances do not see, alone and by up to a factor of two,
  // refines the best of them, and adds it, or the same with all other values refined, if it leaves no more
  // than noise. Returns whether there is one. A fit of all values at once seldom gets to one that is far off:
  // where neither the oil's spring nor the pressure at which a valve opens shows in a balance, every other
  // value tries to stand in for it.
  bool RaceValues();
  // The place of the best set without the effect. The candidates include the same set without it, with
  // values as they are or refined, because values that were estimated with or without an effect may not suit
  // what is left. Only a few sets are made this way. Returns the number of sets where there is none.
  size_t Without(size_t with, const Change& change, Values values);
  // The same effects with the given base values, refined.
  size_t WithGivenValues(size_t place);
  // Refines the set as far as allowed, with values fitted to the windows and to whole runs, where they
  // predict better.
  void RefineForReport(size_t place);

  // How probable the balances say the effect is; 0 where they say nothing.
  double SaidOf(const Change& effect) const;
  // What the effect has to gain, given what the balances say about it. An effect that they cannot see is
  // priced at the odds of any effect; without balances, at even odds.
  double PriceOf(const Change& effect) const;

  const std::vector<ProvedSet>& all() const { return sets_; }
  size_t size() const { return sets_.size(); }
  const ProvedSet& operator[](size_t place) const { return sets_[place]; }
  // The same set with its far windows judged.
  const ProvedSet& Far(size_t place);
  const ProofWindows& windows() const { return windows_; }
  const ProofContext& context() const { return context_; }
  bool has_fitted() const { return !fitted_.empty(); }

 private:
  ProvedSet& Push(ProvedSet set);
  void AddProposal(const Proposal& proposal);
  void BeginAtGivenValues(ProvedSet* set) const;
  void BeginAtBestValues(ProvedSet* set) const;
  void RefineOnWholeRuns(ProvedSet* set) const;
  // The model as given with the one other value that predicts the fitted windows best, judged by the others;
  // nothing where none helps.
  std::optional<ProvedSet> BestSingleValue();
  // Whether the balances of some set say much more of this base value than the model does.
  bool IsSeenByBalances(size_t base) const;

  const ProofContext& context_;
  const Hypothesis& as_given_;
  const std::vector<size_t>& allowed_;
  const SaidByBalances& said_;
  ProofWindows windows_;
  std::vector<ProvedSet> sets_;
  std::vector<RunData> scaled_;  // the windows that fits use
  std::vector<const RunData*> fitted_;
  struct Made {
    size_t from;     // the set from which an effect was removed
    Change without;  // the effect
    size_t place;    // the set that was made
  };
  std::vector<Made> made_;
};

}  // namespace hydro::diagnose
