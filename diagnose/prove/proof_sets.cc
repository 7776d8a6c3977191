#include "diagnose/prove/proof_sets.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "diagnose/evidence/change_set.h"
#include "diagnose/fit/closure.h"
#include "diagnose/fit/fit.h"
#include "diagnose/fit/likeliest_scale.h"
#include "diagnose/prove/blind_changes.h"
#include "diagnose/prove/refined_values.h"
#include "diagnose/prove/whole_runs.h"
#include "diagnose/recording/thinned.h"

namespace hydro::diagnose {
namespace {

// Limit for fits to whole runs: numbers times samples, some seconds of work.
constexpr size_t kMostNumbersTimesSamples = 200000;
// How many sets are made by removing one of their effects: enough for two leading sets with three effects,
// and what remains of them.
constexpr size_t kMostMade = 10;
// By what factor a value that balances do not see is moved as long as that helps, up to kImplausible. The
// frequency of a spring changes by half as much, so a fit finds the way from the nearest of these values. The
// first move is as far as the value is uncertain, if that is less: from a displacement that is 5 % off, a
// step of a quarter leads farther away either way.
constexpr double kRaced = 1.25;
// From there on in steps of half the size each: at a pressure at which a valve opens, the gap has a bend that
// no derivative passes.
constexpr double kLastStep = 1.005;

double model::Parameters::*MemberOf(const Change& value) {
  return model::BaseParameters()[model::BasePlace(value.parameter)].member;
}

// The same windows, with those that are fitted as judges: whatever moves a value must not see the runs that
// prove it.
ProofWindows JudgedByFitted(ProofWindows windows) {
  const std::shared_ptr<KnownTurns> turns =
      windows.near.turns == nullptr ? nullptr : std::make_shared<KnownTurns>(windows.fitted.size());
  windows.near = {windows.near.seconds, windows.fitted, std::vector<size_t>(windows.fitted.size(), 0), turns};
  windows.far = {};
  return windows;
}

}  // namespace

ProofSets::ProofSets(const ProofContext& context, const Hypothesis& as_given,
                     const std::vector<size_t>& allowed, const SaidByBalances& said)
    : context_(context),
      as_given_(as_given),
      allowed_(allowed),
      said_(said),
      windows_(ProofWindowsOf(context)) {
  sets_.emplace_back().hypothesis = as_given;
  JudgeSet(windows_, context_.jobs, &sets_.back());
  // A proposed effect is searched with the first set that has it, as the balances estimate it. Where the
  // model as given has one itself, every set is searched: the turns that suit its wrong values mislead all
  // others, as on a motor whose J was 18 % too small.
  const std::vector<model::EffectDescription>& own = context.given.effects;
  const bool repeats = std::ranges::any_of(own, [](const model::EffectDescription& effect) {
    return model::HasRole(effect.id, model::Role::kPeriods);
  });
  for (JudgingWindows* judging : {&windows_.near, &windows_.far})
    if (!repeats) judging->turns = std::make_shared<KnownTurns>(judging->windows.size());
}

double ProofSets::SaidOf(const Change& effect) const {
  // A curve is reported for a balance but added to both columns of oil, so it has one weight for all.
  const bool curve = IsClosureEffect(effect.effect);
  double said = 0;
  for (const auto& [id, weight] : said_.weights) {
    if (curve ? IsClosureEffect(id) : id == effect.effect) said += weight;
  }
  return said;
}

double ProofSets::PriceOf(const Change& effect) const {
  if (said_.weights.empty()) return diagnose::PriceOf(0.5);
  const double said = SaidOf(effect);
  return diagnose::PriceOf(IsUnseenByBalances(effect.effect) ? std::max(kOddsOfAChange, said) : said);
}

ProvedSet& ProofSets::Push(ProvedSet set) {
  set.price = 0;
  for (const Change& effect : set.Effects()) set.price += PriceOf(effect);
  return sets_.emplace_back(std::move(set));
}

void ProofSets::AddProposal(const Proposal& proposal) {
  Hypothesis hypothesis = as_given_;
  hypothesis.model = proposal.model;
  hypothesis.changes = proposal.changes;
  hypothesis.base = proposal.base;
  // Over windows in which little changes, a motor ten times as heavy predicts that nothing changes. The
  // balances know better.
  hypothesis.reach =
      std::make_shared<const ValueReach>(ReachOf(context_.given.parameters, proposal.model.parameters));
  hypothesis.measured =
      std::make_shared<const MeasuredValues>(MeasuredValues{proposal.model.parameters, proposal.deviation});
  // Estimates hold one number of each balance, which scales all others. A fit moves that number instead of
  // the others. Where nothing but values differs, windows may show one that the balances do not.
  for (const size_t place : allowed_) {
    const bool all = proposal.base.size() > static_cast<size_t>(kMostChanges) || proposal.changes.empty();
    const bool there = std::ranges::find(proposal.base, place) != proposal.base.end();
    if (all && !there) hypothesis.base.push_back(place);
  }
  for (const Change& change : proposal.changes) {
    if (!change.effect.empty()) hypothesis.effects.push_back(change.effect);
  }
  // The estimate moves the numbers of the model's own effects just as it moves base values. Periods of a turn
  // are whole numbers.
  for (const model::EffectDescription& effect : context_.given.effects) {
    if (!proposal.base.empty() && !model::HasRole(effect.id, model::Role::kPeriods))
      hypothesis.effects.push_back(effect.id);
  }
  ProvedSet set;
  set.hypothesis = std::move(hypothesis);
  set.proposed = proposal.model;
  set.without = proposal.without;
  set.by_run = proposal.by_run;
  set.weight = proposal.weight;
  Push(std::move(set));
}

void ProofSets::Add(const std::vector<Proposal>& proposals) {
  const size_t first = sets_.size();
  bool values = allowed_.empty();
  for (const Proposal& proposal : proposals) {
    AddProposal(proposal);
    values = values || (proposal.changes.empty() && !proposal.base.empty());
  }
  if (!values) {
    Hypothesis refit = as_given_;
    refit.base = allowed_;
    for (const model::EffectDescription& effect : context_.given.effects) refit.effects.push_back(effect.id);
    sets_.emplace_back().hypothesis = std::move(refit);
  }
  for (size_t i = first; i < sets_.size(); ++i) {
    JudgeSet(windows_, context_.jobs, &sets_[i]);
    BeginAtGivenValues(&sets_[i]);
  }
}

void ProofSets::SetFitted(size_t leading) {
  const size_t by = leading < sets_.size() ? leading : kGiven;
  scaled_ = WithDiscrepancy(windows_.fitted, sets_[by].hypothesis.model, context_.jobs);
  fitted_ = PointersTo(scaled_);
}

void ProofSets::BeginAtGivenValues(ProvedSet* set) const {
  if (set->tested()) return;
  set->hypothesis.model.parameters = context_.given.parameters;
  set->UseOneModel();
  JudgeSet(windows_, context_.jobs, set);
}

void ProofSets::BeginAtBestValues(ProvedSet* set) const {
  const size_t values = BestWithEffects(sets_, {});
  if (values >= sets_.size() || set->Effects().empty() || set->hypothesis.base.empty()) return;
  if (set->begun == values) return;
  set->begun = values;
  ProvedSet other = *set;
  other.hypothesis.model.parameters = sets_[values].hypothesis.model.parameters;
  for (size_t r = 0; r < other.without.size(); ++r)
    other.without[r].parameters = sets_[values].ModelOf(r).parameters;
  other.by_run = sets_[values].by_run;
  JudgeSet(windows_, context_.jobs, &other);
  if (PredictsBetter(windows_, context_.jobs, &other, set)) *set = std::move(other);
}

void ProofSets::BeginAtBestValues() {
  for (ProvedSet& set : sets_) {
    if (!set.refined) BeginAtBestValues(&set);
  }
}

void ProofSets::Refine(size_t place) {
  if (place == kGiven || sets_[place].refined) return;
  BeginAtBestValues(&sets_[place]);
  RefineValues(context_, fitted_, windows_, kComparedValues, &sets_[place]);
  sets_[place].refined = true;
}

// Acts where this is affordable and predicts windows better: an effect that acts seldom or slowly moves few
// of the fitted windows.
void ProofSets::RefineOnWholeRuns(ProvedSet* set) const {
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
    // A fit that starts where the windows led may end away from what the balances saw.
    Hypothesis as_proposed = set->hypothesis;
    as_proposed.model = set->proposed;
    Fitted other = Fit(as_proposed, PointersTo(thinned), MeasuredStarts(context_.runs), coarse);
    if (other.ok() && (!fitted.ok() || other.sum < fitted.sum)) fitted = std::move(other);
  }
  if (!fitted.ok()) return;
  whole.hypothesis = fitted.hypothesis;
  MoveToLikeliestScale(context_.given, &whole.hypothesis);
  JudgeSet(windows_, context_.jobs, &whole);
  if (!whole.tested()) return;
  JudgeFar(windows_, context_.jobs, set);
  JudgeFar(windows_, context_.jobs, &whole);
  const GapFall near = FallOf(set->near, whole.near), far = FallOf(set->far, whole.far);
  // Alike is what two standard errors do not tell apart. Windows that scatter strongly say little, but a set
  // that is worse in most of them is worse.
  const auto equal = [](const GapFall& fall) { return std::min(2 * fall.error, kPartOfValues); };
  const bool near_falls = near.Exceeds(0) && far.logarithm >= -equal(far);
  const bool far_falls = far.Exceeds(0) && near.logarithm >= -equal(near);
  // Where windows are too short to decide, whole held-out runs do.
  const bool alike = std::abs(near.logarithm) <= equal(near) && std::abs(far.logarithm) <= equal(far);
  const auto of_runs = [this](const ProvedSet& one) { return MeanSquare(OverRuns(context_, one)); };
  if (near_falls || far_falls || (alike && of_runs(whole) < of_runs(*set))) *set = whole;
}

size_t ProofSets::Without(size_t with, const Change& change, Values values) {
  std::vector<Change> fewer = sets_[with].Effects();
  std::erase(fewer, change);
  auto made =
      std::ranges::find_if(made_, [&](const Made& one) { return one.from == with && one.without == change; });
  if (made == made_.end() && made_.size() < kMostMade) {
    ProvedSet less;
    less.hypothesis = diagnose::Without(sets_[with].hypothesis, change, context_.given);
    less.hypothesis.measured = nullptr;  // with the change
    for (model::ModelDescription without : sets_[with].without) {
      std::erase_if(without.effects, [&](const auto& effect) { return effect.id == change.effect; });
      less.without.push_back(std::move(without));
    }
    JudgeSet(windows_, context_.jobs, &less);
    Push(std::move(less));
    made = made_.insert(made_.end(), {with, change, sets_.size() - 1});
  }
  if (made != made_.end() && values == Values::kRefined) Refine(made->place);
  return BestWithEffects(sets_, fewer);
}

void ProofSets::Race(size_t from, const Change& change) {
  Push(RacedFrom(context_, fitted_, windows_, sets_[from], change));
}

bool ProofSets::IsSeenByBalances(size_t base) const {
  // With half the uncertainty, the runs know three times as much of the value as was known beforehand.
  constexpr double kSeen = 0.5;
  const double known = model::UncertaintyOf(context_.given, base);
  return std::ranges::any_of(sets_, [&](const ProvedSet& set) {
    if (set.hypothesis.measured == nullptr) return false;
    const auto found = set.hypothesis.measured->deviation.find(base);
    return found != set.hypothesis.measured->deviation.end() && found->second < kSeen * known;
  });
}

std::optional<ProvedSet> ProofSets::BestSingleValue() {
  const ProofWindows fitted = JudgedByFitted(windows_);
  ProvedSet given = sets_[kGiven];
  JudgeSet(fitted, context_.jobs, &given);
  std::optional<ProvedSet> best;
  const auto moved = [&](const Change& change, const ProvedSet& from, double factor) {
    ProvedSet one = from;
    one.hypothesis.changes = {change};
    one.hypothesis.base = {model::BasePlace(change.parameter)};
    one.hypothesis.model.parameters.*MemberOf(change) *= factor;
    JudgeSet(fitted, context_.jobs, &one);
    if (PredictsBetter(one, best ? *best : given)) best = one;
    return one;
  };
  for (const Change& change : context_.changes) {
    if (!change.effect.empty() || context_.given.parameters.*MemberOf(change) == 0) continue;
    if (IsSeenByBalances(model::BasePlace(change.parameter))) continue;
    const double unsure = 1 + model::UncertaintyOf(context_.given, model::BasePlace(change.parameter));
    for (const bool up : {false, true}) {
      ProvedSet at = given;
      double step = std::min(kRaced, unsure);
      for (double off = step; off < kImplausible && !TimeIsUp(context_); off *= step) {
        ProvedSet next = moved(change, at, up ? step : 1 / step);
        if (!PredictsBetter(next, at)) break;
        at = std::move(next);
        step = kRaced;
      }
    }
  }
  for (double step = std::sqrt(kRaced); best && step > kLastStep && !TimeIsUp(context_);
       step = std::sqrt(step)) {
    const ProvedSet middle = *best;
    for (const double factor : {1 / step, step}) moved(middle.hypothesis.changes.front(), middle, factor);
  }
  if (best) JudgeSet(windows_, context_.jobs, &*best);
  return best;
}

bool ProofSets::RaceValues() {
  if (fitted_.empty()) return false;
  std::optional<ProvedSet> best = BestSingleValue();
  if (!best || !FallOf(sets_[kGiven].near, best->near).Exceeds(kPartOfAnEffect)) return false;
  RefineValues(context_, fitted_, windows_, kReportedValues, &*best);
  if (TypicalGap(best->near) > kCloseEnough) {
    const size_t raced = best->hypothesis.base.front();
    for (const size_t place : allowed_) {
      if (place != raced) best->hypothesis.base.push_back(place);
    }
    RefineValues(context_, fitted_, windows_, kComparedValues, &*best);
  }
  if (TypicalGap(best->near) > kCloseEnough) return false;
  best->refined = true;
  Push(std::move(*best));
  return true;
}

size_t ProofSets::WithGivenValues(size_t place) {
  ProvedSet sparse = sets_[place];
  sparse.UseOneModel();
  sparse.refined = false;
  sparse.hypothesis.model.parameters = context_.given.parameters;
  sparse.hypothesis.base.clear();
  sparse.hypothesis.known = nullptr;
  sparse.hypothesis.changes = sparse.Effects();
  JudgeSet(windows_, context_.jobs, &sparse);
  RefineValues(context_, fitted_, windows_, kComparedValues, &sparse);
  Push(std::move(sparse));
  return sets_.size() - 1;
}

void ProofSets::RefineForReport(size_t place) {
  RefineValues(context_, fitted_, windows_, kReportedValues, &sets_[place]);
  RefineOnWholeRuns(&sets_[place]);
}

const ProvedSet& ProofSets::Far(size_t place) {
  JudgeFar(windows_, context_.jobs, &sets_[place]);
  return sets_[place];
}

}  // namespace hydro::diagnose
