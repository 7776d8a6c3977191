#include "diagnose/prove/prove.h"

#include <algorithm>
#include <utility>

#include "diagnose/prove/chooser.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proof_sets.h"
#include "diagnose/prove/refined_values.h"
#include "diagnose/prove/whole_runs.h"

namespace hydro::diagnose {
namespace {

// The number of proposals whose values are refined: a scan is useful only if the truth is among its first
// five.
constexpr size_t kMostRefined = 5;

// The proof to report when this set predicts best, with its numbers as precise as possible.
Proof Reported(ProofSets* sets, const Chooser& chooser, size_t best) {
  const ProofContext& context = sets->context();
  sets->SetFitted(best);
  sets->RefineForReport(best);
  context.Report("fitting the whole runs", 0.93);
  const ProofWindows& windows = sets->windows();
  std::vector<RunData> told = WithDiscrepancy(windows.told, (*sets)[best].hypothesis.model, context.jobs);
  // Where other values are all that was found, they are the best ones: a reader sees one refit, not two.
  const bool values_alone = best != ProofSets::kGiven && (*sets)[best].Effects().empty();
  return ProofOf(context, windows, std::move(told), sets->all(),
                 {ProofSets::kGiven, values_alone ? best : chooser.BestValues(), best});
}

// A standard deviation, as a part of a 95 % interval's half width.
constexpr double kOneDeviation = 0.51;

// Whether the windows show what the set `without` lacks of the set `with`.
bool DoWindowsShow(ProofSets* sets, size_t with, size_t without) {
  if (TypicalGap((*sets)[without].near) <= kCloseEnough) return false;
  const GapFall near = FallOf((*sets)[without].near, (*sets)[with].near),
                far = FallOf(sets->Far(without).far, sets->Far(with).far);
  // Six far windows scatter more: what they show is surely there.
  return near.Exceeds(kPartOfValues) || (far.Exceeds(kPartOfAnEffect) && far.logarithm > 2 * far.error);
}

// The place of the best set without an effect that takes next to nothing (TakesNextToNothing()); if there is
// none, the place of the best set.
size_t WithoutWhatTakesNothing(ProofSets* sets, const Proof& proof) {
  if (TimeIsUp(sets->context())) return proof.best;
  for (const Change& change : proof.Best().Effects()) {
    const size_t without = sets->Without(proof.best, change, ProofSets::Values::kRefined);
    if (without >= sets->size() || without == proof.best) continue;
    if (!TakesNextToNothing(proof.Best(), (*sets)[without], proof.Values())) continue;
    sets->RefineForReport(without);
    return without;
  }
  return proof.best;
}

// The place of the best set without an effect that may be absent and that the windows do not show either; if
// there is no such effect, the place of the best set. Amounts that can replace each other may each be 0, but
// not both: then the windows do show the effect. Where much more than noise is left, something else is
// missing. Windows then show whatever stands in for it, so an amount has to exceed its own error.
size_t WithoutWhatIsNotShown(ProofSets* sets, const Proof& proof) {
  // Without time to refit what is left, a set without the effect is no judge of it.
  const bool more_is_missing =
      !TimeIsUp(sets->context()) && TypicalGap((*sets)[proof.best].near) > kNoiseAndAsMuchAgain;
  const std::vector<Change> may_be_none = MayBeNone(sets->context(), proof);
  std::vector<Change> stands_in;
  if (more_is_missing && !may_be_none.empty()) stands_in = MayBeNone(sets->context(), proof, kOneDeviation);
  for (const Change& change : may_be_none) {
    const size_t without = sets->Without(proof.best, change, ProofSets::Values::kRefined);
    if (without >= sets->size() || without == proof.best) continue;
    sets->RefineForReport(without);  // as well fitted as what it is to replace
    const bool in_error = std::ranges::find(stands_in, change) != stands_in.end();
    if (in_error || !DoWindowsShow(sets, proof.best, without)) return without;
  }
  return proof.best;
}

}  // namespace

Proof ProveProposals(const ProofContext& context, const Hypothesis& as_given,
                     const std::vector<size_t>& allowed, const std::vector<Proposal>& proposals,
                     const std::vector<Change>& blind, const SaidByBalances& said) {
  context.Report("simulating the proposals", 0.85);
  ProofSets sets(context, as_given, allowed, said);
  sets.Add(proposals);
  sets.SetFitted(LeadingSet(sets.all()));
  context.Report("refining their values", 0.88);
  for (const size_t i : WorthRefining(sets.all(), 0)) sets.Refine(i);
  sets.BeginAtBestValues();
  for (const size_t i : WorthRefining(sets.all(), kMostRefined)) sets.Refine(i);
  Chooser chooser(&sets);
  size_t best = chooser.Choice();
  if (chooser.LeavesAGap(best)) {
    context.Report("what balances cannot show", 0.91);
    if (!sets.RaceValues()) chooser.Race(best, blind);
    best = chooser.Choice();
  }
  best = chooser.OneNumberForManyValues(best);
  best = chooser.WithWhatBalancesSay(chooser.TakeGivenValues(best));
  Proof proof = Reported(&sets, chooser, best);
  for (const auto& drop : {WithoutWhatTakesNothing, WithoutWhatIsNotShown}) {
    for (size_t shown = best; (shown = drop(&sets, proof)) != best;) {
      best = shown;
      proof = Reported(&sets, chooser, best);
    }
  }
  // At the noise, windows are too short for what is left, if anything is.
  const bool at_the_noise = TypicalGap(proof.Best().near) < kNoiseAndAsMuchAgain;
  return ProvedOnWholeRuns(context, as_given, std::move(proof), at_the_noise, said.unlikely);
}

}  // namespace hydro::diagnose
