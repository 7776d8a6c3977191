// A set of changes under proof: its values, and what they leave of the windows that judge.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/prove/window_gaps.h"

namespace hydro::diagnose {

struct ProvedSet {
  Hypothesis hypothesis;  // with the values that predict best of those tried
  model::ModelDescription proposed =
      {};  // with the values as the balances estimate them; no parameters: it was not proposed
  // Of runs that are held out in turn, the same without each run; empty: the hypothesis' model predicts all.
  std::vector<model::ModelDescription> without;
  std::vector<WindowGap> near;
  std::vector<WindowGap> far;  // empty until a comparison needs them
  double weight = 0;           // of the proposal, 0 of what was not proposed
  bool refined = false;        // as far as sets are to be compared

  bool tested() const { return IsTested(near); }
  std::vector<Change> Effects() const;  // the changes that are not values
  const model::ModelDescription& ModelOf(size_t run) const {
    return without.empty() ? hypothesis.model : without[run];
  }
};

// Predicts the near windows with the set's values.
void JudgeSet(const ProofWindows& windows, int jobs, ProvedSet* set);

// Predicts the far windows, unless that is done.
void JudgeFar(const ProofWindows& windows, int jobs, ProvedSet* set);

// Whether `other`, the same set with other values, takes its place: it predicts the near windows better, and the far ones, as far as
// they are predicted, no worse than by the error of the comparison. What cannot be tested takes no place.
bool PredictsBetter(const ProvedSet& other, const ProvedSet& set);
// The same; predicts far windows where near ones do not say no.
bool PredictsBetter(const ProofWindows& windows, int jobs, ProvedSet* other, ProvedSet* set);

// The part of the gap over the near windows that an effect has to take, given the same set without it. Measured with a prototype
// on 11 cases: it left out further effects that were not there on 5 of 6 rigs, and both on rigs that lacked nothing.
inline constexpr double kPartOfAnEffect = 0.1;
// The same where the balances, which see all of the fitted runs, say the effect at nine to one or more: two witnesses, of whom each
// need be half as sure.
inline constexpr double kPartOfASaidEffect = 0.05, kSaid = 0.9;
// Other values are likelier than a missing effect: no machine has exactly the values of its model.
inline constexpr double kPartOfValues = 0.05;

// Whether the gap without it tells against `with`, which has one effect more: that has to take its part of the near windows' gap,
// and must not make the far ones worse by as much. True where either cannot be tested: no simulation, no veto.
bool IsEffectKept(const ProvedSet& with, const ProvedSet& without, double part = kPartOfAnEffect);
// The same of other values, against the model as given.
bool AreValuesKept(const ProvedSet& with, const ProvedSet& as_given);

// The place of the set that predicts the near windows best, if each of its effects has to take its part. Of equals the likelier
// proposal, then the first. The number of sets where none can be tested.
size_t LeadingSet(const std::vector<ProvedSet>& sets);

// The places of sets with free values that are worth a refinement: those of values alone, and the `most` that predict best with
// effects, as LeadingSet() compares them; in their order.
std::vector<size_t> WorthRefining(const std::vector<ProvedSet>& sets, size_t most);

// The best of those with exactly these effects, in any order; the number of sets where none can be tested.
size_t BestWithEffects(const std::vector<ProvedSet>& sets, const std::vector<Change>& effects);

}  // namespace hydro::diagnose
