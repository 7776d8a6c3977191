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
  double price = 0;            // of all its effects (PriceOf())
  double price_of_values = 0;  // of how far its base values are from those given, in the same measure
  bool refined = false;        // as far as sets are to be compared

  bool tested() const { return IsTested(near); }
  std::vector<Change> Effects() const;  // the changes that are not values
  const model::ModelDescription& ModelOf(size_t run) const {
    return without.empty() ? hypothesis.model : without[run];
  }
};

// Predicts the near windows with the set's values, and prices these.
void JudgeSet(const ProofWindows& windows, int jobs, ProvedSet* set);

// Predicts the far windows, unless that is done.
void JudgeFar(const ProofWindows& windows, int jobs, ProvedSet* set);

// Whether `other`, the same set with other values, takes its place: it predicts the near windows better, and the far ones, as far as
// they are predicted, no worse than by the error of the comparison. What cannot be tested takes no place.
bool PredictsBetter(const ProvedSet& other, const ProvedSet& set);
// The same; predicts far windows where near ones do not say no.
bool PredictsBetter(const ProofWindows& windows, int jobs, ProvedSet* other, ProvedSet* set);

// What an effect has to take of the logarithm of the near windows' gap, beyond the error of the comparison, where the balances of the
// fitted runs give it this weight. Balances and held-out windows are two witnesses whose odds multiply: effects that are not there
// take some per cent by mending what else is wrong, the less often the more, so that a twentieth of the gap is worth nine to one. Even
// odds have to be paid with a twentieth; at nine to one, windows need only agree; where the balances are sure, they may not object.
double PriceOf(double weight);
// The same exchange the other way: what a fall of this logarithm is worth, as the logarithm of odds.
double LogOddsOf(double fall);

// The fall of the near windows' gap from one set to another, less what the prices of effects and values rise.
GapFall WorthOf(const ProvedSet& from, const ProvedSet& to);

// Of the gap: what is more than chance whatever the balances say. A further effect takes it in hardly any rig that lacks none.
inline constexpr double kPartOfAnEffect = 0.1;
// Other values are likelier than a missing effect: no machine has exactly the values of its model.
inline constexpr double kPartOfValues = 0.05;
// Sets whose gaps differ by less predict equally well: a tenth of what an effect has to take.
inline constexpr double kEqual = 0.01;

// Whether `with` is worth the price of the one effect that it has more than `without`, over the near windows; and does not make the far
// ones, as far as they are predicted, worse by kPartOfAnEffect. True where either cannot be tested: no simulation, no veto.
bool IsEffectKept(const ProvedSet& with, const ProvedSet& without, double price);
// The same of other values, against the model as given.
bool AreValuesKept(const ProvedSet& with, const ProvedSet& as_given);

// The place of the set that predicts the near windows best beyond the price of its effects. Of equals the likelier
// proposal, then the first. The number of sets where none can be tested.
size_t LeadingSet(const std::vector<ProvedSet>& sets);

// The places of sets with free values that are worth a refinement: those of values alone, and the `most` that predict best with
// effects, as LeadingSet() compares them; in their order.
std::vector<size_t> WorthRefining(const std::vector<ProvedSet>& sets, size_t most);

// The best of those with exactly these effects, in any order; the number of sets where none can be tested.
size_t BestWithEffects(const std::vector<ProvedSet>& sets, const std::vector<Change>& effects);

}  // namespace hydro::diagnose
