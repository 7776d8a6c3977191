// The sets of changes under proof, judged and refined on the same windows.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proof_windows.h"
#include "diagnose/prove/proposal.h"
#include "diagnose/prove/proved_set.h"

namespace hydro::diagnose {

class ProofSets {
 public:
  static constexpr size_t kGiven = 0;  // the place of the model as given

  // `allowed`: indices in BaseParameters() of those that a refit may move. Keeps references to all.
  ProofSets(const ProofContext& context, const Hypothesis& as_given, const std::vector<size_t>& allowed,
            const SaidByBalances& said);

  // Adds the proposals as judged with their own values, and a refit where no proposal has other values alone. Where proposed values
  // cannot be simulated, those of the model as given stand in.
  void Add(const std::vector<Proposal>& proposals);
  // The windows that are fitted from here on, with the discrepancy that the set at this place leaves.
  void SetFitted(size_t leading);
  // Sets with effects begin at the values of the best set of values alone, where these suit their effects better: a set is not worth
  // less for values that nobody fitted.
  void BeginAtBestValues();
  // A few steps of a fit, once a set.
  void Refine(size_t place);
  // A set fitted with a change more, from the catalogue's starts, judged.
  void Race(size_t from, const Change& change);
  // The place of the best set without the effect, among them the set itself without it, refined: values that were estimated beside an
  // effect, or without one, may not suit what is left. Few are made; the number of sets where there is none.
  size_t Without(size_t with, const Change& change);
  // The same effects with the base values as given, refined.
  size_t WithGivenValues(size_t place);
  // As far as it may be, with values fitted to the windows and to whole runs, where they predict better.
  void RefineForReport(size_t place);

  // How probable the effect is as the balances speak of it; 0 where they do not.
  double SaidOf(const Change& effect) const;
  // What the effect has to take, as the balances speak of it; of what they cannot see, at the odds of any effect; at even ones without balances.
  double PriceOf(const Change& effect) const;

  const std::vector<ProvedSet>& all() const { return sets_; }
  size_t size() const { return sets_.size(); }
  const ProvedSet& operator[](size_t place) const { return sets_[place]; }
  // The same with its far windows judged.
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

  const ProofContext& context_;
  const Hypothesis& as_given_;
  const std::vector<size_t>& allowed_;
  const SaidByBalances& said_;
  ProofWindows windows_;
  std::vector<ProvedSet> sets_;
  std::vector<RunData> scaled_;  // the windows that are fitted
  std::vector<const RunData*> fitted_;
  std::vector<std::pair<size_t, Change>> made_;  // sets without an effect: of which set, which effect
};

}  // namespace hydro::diagnose
