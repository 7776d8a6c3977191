#include "diagnose/prove/unrecorded.h"

#include <algorithm>
#include <utility>

#include "base/word_list.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/wave_periods.h"
#include "diagnose/prove/blind_changes.h"

namespace hydro::diagnose {
namespace {

// Signals that a balance needs and that no run has.
std::vector<std::string> MissingSignals(const std::vector<RunMotion>& runs) {
  bool p1 = true, p2 = true, speed = true, arm = true, oil = false, moves = false;
  for (const RunMotion& run : runs) {
    speed = speed && !run.speed_known;
    if (run.options.bypass) continue;
    oil = true;
    p1 = p1 && !run.Of(GridChannel::kP1).measured();
    p2 = p2 && !run.Of(GridChannel::kP2).measured();
    moves = moves || run.options.shaft != model::Shaft::kClamped;
    arm = arm && !run.arm_moves;
  }
  std::vector<std::string> missing;
  if (oil && p1) missing.emplace_back("p1");
  if (oil && p2) missing.emplace_back("p2");
  if (speed) missing.emplace_back("motor_speed");
  if (moves && arm) missing.emplace_back("arm_angle");
  return missing;
}

}  // namespace

namespace {

// Effects that repeat with a shaft that was not seen to turn far enough.
std::vector<Unjudged> UnseenWaves(const ScanRuns& runs) {
  if (FewestPeriods(runs.motions()) <= kMostPeriods) return {};
  Unjudged unseen{{}, "the motor turns too little to show whether anything repeats with its shaft"};
  for (const EffectVariant& variant : runs.setup().variants) {
    if (variant.kind == EffectVariant::Kind::kWave) unseen.effects.push_back(variant.change.effect);
  }
  std::ranges::sort(unseen.effects);
  unseen.effects.erase(std::unique(unseen.effects.begin(), unseen.effects.end()), unseen.effects.end());
  if (unseen.effects.empty()) return {};
  return {unseen};
}

}  // namespace

std::vector<std::string> ParametersByRun(const ChangeSet& set) {
  const std::string prefix = "run.";
  std::vector<std::string> names;
  for (const std::string& change : set) {
    if (change.starts_with(prefix)) names.push_back(change.substr(prefix.size()));
  }
  return names;
}

bool NamesARun(const ChangeSet& set) { return !ParametersByRun(set).empty(); }

std::vector<Unjudged> UnjudgedOf(const ProofContext& context, const ScanRuns& runs,
                                 const std::vector<std::string>& names) {
  const std::vector<std::string> missing = MissingSignals(runs.motions());
  std::vector<Unjudged> unjudged = UnseenWaves(runs);
  if (missing.empty()) return unjudged;
  const std::set<std::string> oil = runs.OilOnly();
  std::set<std::string> judged, some_oil, all;
  for (const std::string& name : names) {
    const std::string id = EffectOf(name);
    (oil.contains(name) ? some_oil : judged).insert(id);
  }
  for (const Change& change : BlindChanges(context)) judged.insert(change.effect);
  const bool torque = std::any_of(runs.motions().begin(), runs.motions().end(),
                                  [](const RunMotion& run) { return CanForm(run, BalanceKind::kTorque); });
  for (const EffectVariant& variant : runs.setup().variants) {
    // A sensor that was not recorded cannot be wrong.
    if (variant.change.effect.starts_with("sensor.")) continue;
    // An effect that repeats with the shaft is in no row before its period is known.
    if (variant.kind == EffectVariant::Kind::kWave && torque) judged.insert(variant.change.effect);
    all.insert(variant.change.effect);
  }
  const std::string because = Enumerated(missing) + (missing.size() > 1 ? " were" : " was") + " not recorded";
  Unjudged gone{{}, because}, one_class{{}, because + ", and without them they cannot be told apart"};
  for (const std::string& id : all) {
    if (judged.contains(id)) continue;
    (some_oil.contains(id) ? one_class : gone).effects.push_back(id);
  }
  for (const Unjudged& one : {gone, one_class}) {
    if (!one.effects.empty()) unjudged.push_back(one);
  }
  return unjudged;
}

std::vector<ChangeSet> SetsWithout(const std::set<std::string>& oil, const ExplanationWeights& weights) {
  std::vector<ChangeSet> sets = {{}};
  for (size_t i = 0; i < std::min(weights.in_90, weights.explanations.size()); ++i) {
    ChangeSet set = weights.explanations[i].set;
    std::erase_if(set, [&](const std::string& name) { return oil.contains(name); });
    if (!NamesARun(set) && std::ranges::find(sets, set) == sets.end()) sets.push_back(set);
  }
  return sets;
}

ExplanationWeights AsOneClass(const std::set<std::string>& oil, ExplanationWeights weights) {
  if (oil.empty()) return weights;
  ExplanationWeights merged;
  for (WeighedExplanation& one : weights.explanations) {
    const size_t before = one.set.size();
    ChangeSet others = one.set;
    std::erase_if(others, [&](const std::string& name) { return oil.contains(name); });
    if (others.size() < before) {
      one.changes = ChangesOf(others);
      one.changes.emplace_back(kSomeOil);
    }
    const auto same = std::ranges::find_if(
        merged.explanations, [&](const WeighedExplanation& other) { return other.changes == one.changes; });
    if (same == merged.explanations.end())
      merged.explanations.push_back(std::move(one));
    else
      same->weight += one.weight;
  }
  merged.in_90 = SortByWeight(&merged.explanations);
  return merged;
}

}  // namespace hydro::diagnose
