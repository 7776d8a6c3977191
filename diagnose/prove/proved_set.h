// A set of changes under proof: its values, and what they leave of the judging windows.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/prove/window_gaps.h"

namespace hydro::diagnose {

struct ProvedSet {
  Hypothesis hypothesis;  // with the values that predict best among those tried
  model::ModelDescription proposed =
      {};  // with the values that the balances estimate; without parameters: not proposed
  // When runs are held out in turn, the same model without each run. Empty: the hypothesis' model predicts
  // all runs.
  std::vector<model::ModelDescription> without;
  std::vector<std::string> by_run;  // parameters of which each of these models has its run's own value
  std::vector<WindowGap> near;
  std::vector<WindowGap> far;   // empty until a comparison needs them
  double weight = 0;            // of the proposal; 0 if it was not proposed
  double price = 0;             // the sum over its effects (PriceOf())
  bool refined = false;         // refined as far as comparison of sets needs
  std::optional<size_t> begun;  // the place of the set whose values it was last tried with

  // From here on the hypothesis' model predicts all runs.
  void UseOneModel() {
    without.clear();
    by_run.clear();
  }
  bool tested() const { return IsTested(near); }
  std::vector<Change> Effects() const;  // the changes other than values
  bool HasCurve() const;                // whether one of them is an unknown curve
  const model::ModelDescription& ModelOf(size_t run) const {
    return without.empty() ? hypothesis.model : without[run];
  }
};

// Predicts the near windows with the set's values, and sets the price of these values.
void JudgeSet(const ProofWindows& windows, int jobs, ProvedSet* set);

// Predicts the far windows, unless they are already predicted.
void JudgeFar(const ProofWindows& windows, int jobs, ProvedSet* set);

// Whether `other`, the same set with other values, should replace `set`: it predicts the near windows better,
// and the far windows, if they were predicted, no worse than by the error of the comparison. A set that
// cannot be tested replaces nothing.
bool PredictsBetter(const ProvedSet& other, const ProvedSet& set);
// The same, but predicts far windows when the near ones do not already say no.
bool PredictsBetter(const ProofWindows& windows, int jobs, ProvedSet* other, ProvedSet* set);

// By how much an effect has to reduce the logarithm of the near windows' gap, beyond the error of the
// comparison, when the balances of the fitted runs give the effect this weight. Balances and held-out windows
// are two witnesses whose odds multiply. Absent effects can reduce the gap by some per cent because they
// compensate other errors; larger reductions are rarer, so that a twentieth of the gap is worth odds of nine
// to one. At even odds the effect has to gain a twentieth. At nine to one the windows only have to agree.
// Where the balances are sure, the windows only must not object.
double PriceOf(double weight);
// The inverse of that exchange: the log odds that a fall of this logarithm is worth.
double LogOddsOf(double fall);
// The inverse: the fall of the logarithm of a gap that is worth these odds.
double FallWorth(double log_odds);

// The fall of the near windows' gap from one set to another, less the rise of the prices of effects and
// values.
GapFall WorthOf(const ProvedSet& from, const ProvedSet& to);

// The part of the gap that is more than chance, whatever the balances say. In hardly any rig that lacks no
// effect does a further effect gain this much.
inline constexpr double kPartOfAnEffect = 0.1;
// Other values are likelier than a missing effect: no machine has exactly the values of its model.
inline constexpr double kPartOfValues = 0.05;
// Sets whose gaps differ by less predict equally well: a tenth of what an effect has to gain.
inline constexpr double kEqual = 0.01;
// The odds of nine to one are worth this part of the gap.
inline constexpr double kEven = 0.05, kWorthIt = 9;
// No balance is surer of a form: machines never match one exactly.
inline constexpr double kMostOdds = 1000;

// Whether `with` is worth the price of the one effect that it has more than `without` over the near windows,
// and does not make the far windows, if they were predicted, worse by kPartOfAnEffect. True where either set
// cannot be tested: without a simulation there is no veto.
bool IsEffectKept(const ProvedSet& with, const ProvedSet& without, double price);
// The same for other values, compared with the model as given: worth kPartOfValues.
bool AreValuesKept(const ProvedSet& with, const ProvedSet& as_given);
// Whether much more than noise is left with the effect, and the effect takes less than a hundredth of the
// squared gap that other `values` leave. Balances are sure of such an effect, because they are sure also of
// what stands in for something else that is missing.
bool TakesNextToNothing(const ProvedSet& with, const ProvedSet& without, const ProvedSet& values);

// The place of the set that predicts the near windows best after the price of its effects. Of equal sets the
// likelier proposal leads, then the first. Returns the number of sets where none can be tested.
size_t LeadingSet(const std::vector<ProvedSet>& sets);

// The places, in order, of the sets with free values that are worth a refinement: the sets of values alone,
// and the `most` best sets with effects by the comparison of LeadingSet().
std::vector<size_t> WorthRefining(const std::vector<ProvedSet>& sets, size_t most);

// The best set with exactly these effects, in any order; the number of sets where none can be tested.
size_t BestWithEffects(const std::vector<ProvedSet>& sets, const std::vector<Change>& effects);

}  // namespace hydro::diagnose
