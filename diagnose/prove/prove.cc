#include "diagnose/prove/prove.h"

#include <algorithm>
#include <utility>

#include "diagnose/data/thinned.h"
#include "diagnose/fit/fit.h"
#include "diagnose/prove/blind_changes.h"
#include "diagnose/prove/proof_windows.h"
#include "diagnose/prove/proved_set.h"
#include "diagnose/prove/refined_values.h"
#include "diagnose/prove/whole_runs.h"
#include "diagnose/search/search_context.h"

namespace hydro::diagnose {

namespace {

// Numbers that are fitted to whole runs times their samples: some seconds of work.
constexpr size_t kMostNumbersTimesSamples = 200000;
constexpr size_t kGiven = 0;  // the place of the model as given
// Proposals whose values are refined: a scan has to have what is true among its first five to be of use.
constexpr size_t kMostRefined = 5;
// Sets without one of their effects that are made: those of two that lead with three effects, and what is left of them.
constexpr size_t kMostMade = 10;
// Of the gap: sets that differ by less predict equally well.
constexpr double kNoBetter = 0.01;

bool RepeatsWithTheShaft(const model::EffectDescription& effect) {
  const model::EffectInfo* info = model::FindEffect(effect);
  return info != nullptr &&
         std::any_of(info->parameters.begin(), info->parameters.end(),
                     [](const auto& parameter) { return parameter.role == model::Role::kPeriods; });
}

// How many numbers the set adds to the model.
size_t NumbersOf(const ProvedSet& set) {
  size_t numbers = 0;
  for (const Change& change : set.Effects()) {
    for (const model::EffectDescription& effect : set.hypothesis.model.effects) {
      if (effect.id != change.effect) continue;
      numbers += effect.parameters.size();
      const auto values = effect.lists.find("values");
      numbers += values == effect.lists.end() ? 0 : values->second.size();
    }
  }
  return numbers;
}

bool HasACurve(const ProvedSet& set) {
  const std::vector<Change> effects = set.Effects();
  return std::any_of(effects.begin(), effects.end(),
                     [](const Change& change) { return change.effect.starts_with("closure."); });
}

class Prover {
 public:
  Prover(const SearchContext& context, const Hypothesis& as_given, const std::vector<size_t>& allowed,
         const std::map<std::string, double>& said)
      : context_(context),
        as_given_(as_given),
        allowed_(allowed),
        said_(said),
        windows_(ProofWindowsOf(context)) {
    sets_.emplace_back().hypothesis = as_given;
  }

  Proof Run(const std::vector<Proposal>& proposals, const std::vector<Change>& blind) {
    Report("simulating the proposals", 0.85);
    AddProposals(proposals);
    for (ProvedSet& set : sets_) JudgeSet(windows_, context_.jobs, &set);
    for (ProvedSet& set : sets_) BeginAtGivenValues(&set);
    SetFitted(LeadingSet(sets_));
    Report("refining their values", 0.88);
    for (const size_t i : WorthRefining(sets_, kMostRefined)) Refine(i);
    size_t best = Choice();
    if (LeavesAGap(best)) {
      Report("what balances cannot show", 0.91);
      Race(best, blind);
      best = Choice();
    }
    best = TakeGivenValues(best);
    SetFitted(best);
    RefineValues(context_, fitted_, windows_, kReportedValues, &sets_[best]);
    RefineOnWholeRuns(&sets_[best]);
    Report("fitting the whole runs", 0.93);
    scaled_ = WithDiscrepancy(windows_.told, sets_[best].hypothesis.model, context_.jobs);
    // As much beside the noise as the noise itself: the windows are too short for what is left, if anything.
    const bool at_the_noise = TypicalGap(sets_[best].near) < 2;
    return ProvedOnWholeRuns(
        context_, as_given_,
        ProofOf(context_, windows_, std::move(scaled_), sets_, {kGiven, BestValues(), best}), at_the_noise);
  }

 private:
  void Report(const char* stage, double fraction) const {
    if (context_.report_progress) context_.report_progress({stage, fraction});
  }

  void AddProposals(const std::vector<Proposal>& proposals) {
    bool values = false;
    for (const Proposal& proposal : proposals) {
      Hypothesis hypothesis = as_given_;
      hypothesis.model = proposal.model;
      hypothesis.changes = proposal.changes;
      hypothesis.base = proposal.base;
      // Estimates hold one number of each balance, which scales all others: a fit moves it instead of them.
      for (const size_t place : allowed_) {
        const bool all = proposal.base.size() > static_cast<size_t>(kMostChanges);
        const bool there =
            std::find(proposal.base.begin(), proposal.base.end(), place) != proposal.base.end();
        if (all && !there) hypothesis.base.push_back(place);
      }
      for (const Change& change : proposal.changes) {
        if (!change.effect.empty()) hypothesis.effects.push_back(change.effect);
      }
      // The estimate moves the numbers of effects that the model has as it moves base values. Periods of a turn are whole numbers.
      for (const model::EffectDescription& effect : context_.given.effects) {
        if (!proposal.base.empty() && !RepeatsWithTheShaft(effect)) hypothesis.effects.push_back(effect.id);
      }
      ProvedSet& set = sets_.emplace_back();
      set.hypothesis = std::move(hypothesis);
      set.proposed = proposal.model;
      set.without = proposal.without;
      set.weight = proposal.weight;
      values = values || (proposal.changes.empty() && !proposal.base.empty());
    }
    if (values || allowed_.empty()) return;
    Hypothesis refit = as_given_;
    refit.base = allowed_;
    for (const model::EffectDescription& effect : context_.given.effects) refit.effects.push_back(effect.id);
    sets_.emplace_back().hypothesis = std::move(refit);
  }

  // The discrepancy is that of the best set so far: what nothing explains.
  void SetFitted(size_t leading) {
    const size_t by = leading < sets_.size() ? leading : kGiven;
    scaled_ = WithDiscrepancy(windows_.fitted, sets_[by].hypothesis.model, context_.jobs);
    fitted_ = PointersTo(scaled_);
  }

  // Where estimated values cannot be simulated, those of the model as given may be.
  void BeginAtGivenValues(ProvedSet* set) const {
    if (set->tested()) return;
    set->hypothesis.model.parameters = context_.given.parameters;
    set->without.clear();
    JudgeSet(windows_, context_.jobs, set);
  }

  void Refine(size_t place) {
    if (place == kGiven || sets_[place].refined) return;
    RefineValues(context_, fitted_, windows_, kComparedValues, &sets_[place]);
    sets_[place].refined = true;
  }

  // Values as fitted to the whole runs, where that is affordable, and where it predicts windows better: what acts seldom or slowly moves
  // few of the fitted windows.
  void RefineOnWholeRuns(ProvedSet* set) const {
    if (set->hypothesis.Free().empty() || !set->without.empty()) return;
    std::vector<RunData> thinned;
    size_t samples = 0;
    for (const RunData* run : context_.runs) {
      thinned.push_back(ThinnedCopy(*run));
      samples += thinned.back().samples();
    }
    if (set->hypothesis.Free().size() * samples > kMostNumbersTimesSamples) return;
    FitOptions coarse = FineFit(context_.jobs);
    coarse.tolerance = kToCompare;
    ProvedSet whole = *set;
    Fitted fitted = Fit(set->hypothesis, PointersTo(thinned), MeasuredStarts(context_.runs), coarse);
    if (set->proposed.parameters.J > 0) {
      // A fit from where the windows led may end beside what the balances saw.
      Hypothesis as_proposed = set->hypothesis;
      as_proposed.model = set->proposed;
      Fitted other = Fit(as_proposed, PointersTo(thinned), MeasuredStarts(context_.runs), coarse);
      if (other.ok() && (!fitted.ok() || other.sum < fitted.sum)) fitted = std::move(other);
    }
    if (!fitted.ok()) return;
    whole.hypothesis = fitted.hypothesis;
    JudgeSet(windows_, context_.jobs, &whole);
    if (!whole.tested()) return;
    const GapFall near = FallOf(set->near, whole.near), far = FallOf(set->far, whole.far);
    const bool near_falls = near.Exceeds(0) && far.logarithm >= -far.error;
    const bool far_falls = far.Exceeds(0) && near.logarithm >= -near.error;
    if (near_falls || far_falls) *set = whole;
  }

  // The best set without the effect, among them the set itself without it, refined: values that were estimated beside an effect, or
  // without one, may not suit what is left.
  size_t PlaceWithout(size_t with, const Change& change) {
    std::vector<Change> fewer = sets_[with].Effects();
    std::erase(fewer, change);
    const std::pair<size_t, Change> made{with, change};
    if (made_.size() >= kMostMade || std::find(made_.begin(), made_.end(), made) != made_.end())
      return BestWithEffects(sets_, fewer);
    made_.push_back(made);
    ProvedSet less;
    less.hypothesis = Without(sets_[with].hypothesis, change, context_.given);
    for (model::ModelDescription without : sets_[with].without) {
      std::erase_if(without.effects, [&](const auto& effect) { return effect.id == change.effect; });
      less.without.push_back(std::move(without));
    }
    JudgeSet(windows_, context_.jobs, &less);
    sets_.push_back(std::move(less));
    Refine(sets_.size() - 1);
    return BestWithEffects(sets_, fewer);
  }

  // What the effect has to take of the gap.
  double PartOf(const Change& change) const {
    const auto weight = said_.find(change.effect);
    return weight != said_.end() && weight->second >= kSaid ? kPartOfASaidEffect : kPartOfAnEffect;
  }

  // The best of the sets that remain when one of the effects that are not needed is left out; the set itself where all are needed.
  size_t Reduced(size_t place) {
    size_t reduced = place;
    double least = 0;
    for (const Change& change : sets_[place].Effects()) {
      const size_t without = PlaceWithout(place, change);
      if (without >= sets_.size() || IsEffectKept(sets_[place], sets_[without], PartOf(change))) continue;
      const double lost = FallOf(sets_[without].near, sets_[place].near).logarithm;
      if (reduced != place && lost >= least) continue;
      reduced = without;
      least = lost;
    }
    return reduced;
  }

  size_t Choice() {
    size_t best = LeadingSet(sets_);
    if (best >= sets_.size()) return kGiven;
    std::vector<size_t> led;  // comparisons of three sets may turn in a circle: each leads once
    for (size_t next = best; std::find(led.begin(), led.end(), next) == led.end();) {
      best = next;
      led.push_back(best);
      Refine(best);
      next = Reduced(best);
      if (next == best) next = BetterOfTheSameSize(best);
    }
    best = WithFewerNumbers(best);
    const bool has_effects = !sets_[best].Effects().empty();
    if (!has_effects && best != kGiven && !AreValuesKept(sets_[best], sets_[kGiven])) best = kGiven;
    return best;
  }

  // Of sets with as many effects that predict as well, the one whose effects have the fewest numbers: a bias has one, an asymmetry two.
  size_t WithFewerNumbers(size_t place) const {
    size_t fewest = place;
    for (size_t i = 0; i < sets_.size(); ++i) {
      if (!sets_[i].tested() || sets_[i].Effects().size() != sets_[place].Effects().size()) continue;
      if (sets_[i].Effects().empty() || NumbersOf(sets_[i]) >= NumbersOf(sets_[fewest])) continue;
      const GapFall fall = FallOf(sets_[i].near, sets_[place].near);
      // A curve fits whatever is there: it has to take as much more as an effect.
      const bool curve = HasACurve(sets_[place]) && !HasACurve(sets_[i]);
      if (!fall.Exceeds(curve ? kPartOfAnEffect : kPartOfValues)) fewest = i;
    }
    return fewest;
  }

  // What is chosen is not worse than another set with as few effects.
  size_t BetterOfTheSameSize(size_t place) const {
    size_t better = place;
    double most = kNoBetter;
    for (size_t i = 0; i < sets_.size(); ++i) {
      if (!sets_[i].tested() || sets_[i].Effects().size() > sets_[place].Effects().size()) continue;
      const double fall = FallOf(sets_[place].near, sets_[i].near).logarithm;
      if (fall <= most) continue;
      most = fall;
      better = i;
    }
    return better;
  }

  bool LeavesAGap(size_t place) const {
    return !TimeIsUp(context_) && sets_[place].Effects().size() < static_cast<size_t>(kMostChanges) &&
           TypicalGap(sets_[place].near) > kCloseEnough;
  }

  void Race(size_t from, const std::vector<Change>& blind) {
    if (fitted_.empty()) return;
    for (const Change& change : blind) {
      const std::vector<model::EffectDescription>& effects = sets_[from].hypothesis.model.effects;
      const bool there = std::any_of(effects.begin(), effects.end(),
                                     [&](const auto& effect) { return effect.id == change.effect; });
      if (!there && !TimeIsUp(context_))
        sets_.push_back(RacedFrom(context_, fitted_, windows_, sets_[from], change));
    }
  }

  // The same effects with the base values as given, where that predicts as well: then no value is said to be wrong.
  size_t TakeGivenValues(size_t place) {
    if (sets_[place].Effects().empty() || sets_[place].hypothesis.base.empty()) return place;
    ProvedSet sparse = sets_[place];
    sparse.without.clear();
    sparse.refined = false;
    sparse.hypothesis.model.parameters = context_.given.parameters;
    sparse.hypothesis.base.clear();
    sparse.hypothesis.known = nullptr;
    sparse.hypothesis.changes = sparse.Effects();
    JudgeSet(windows_, context_.jobs, &sparse);
    RefineValues(context_, fitted_, windows_, kComparedValues, &sparse);
    sets_.push_back(std::move(sparse));
    const bool values = AreValuesKept(sets_[place], sets_.back());
    return values || !sets_.back().tested() ? place : sets_.size() - 1;
  }

  size_t BestValues() const {
    const size_t best = BestWithEffects(sets_, {});
    if (best < sets_.size() && best != kGiven) return best;
    for (size_t i = 1; i < sets_.size(); ++i) {
      // Values as given are among those that a refit may have.
      if (sets_[i].Effects().empty() && PredictsBetter(sets_[i], sets_[kGiven])) return i;
    }
    return kGiven;
  }

  const SearchContext& context_;
  const Hypothesis& as_given_;
  const std::vector<size_t>& allowed_;
  const std::map<std::string, double>& said_;
  ProofWindows windows_;
  std::vector<ProvedSet> sets_;
  std::vector<RunData> scaled_;  // the windows that are fitted
  std::vector<const RunData*> fitted_;
  std::vector<std::pair<size_t, Change>> made_;  // sets without an effect: of which set, which effect
};

}  // namespace

Proof ProveProposals(const SearchContext& context, const Hypothesis& as_given,
                     const std::vector<size_t>& allowed, const std::vector<Proposal>& proposals,
                     const std::vector<Change>& blind, const std::map<std::string, double>& said) {
  return Prover(context, as_given, allowed, said).Run(proposals, blind);
}

}  // namespace hydro::diagnose
