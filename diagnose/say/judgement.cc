#include "diagnose/say/judgement.h"

#include <algorithm>
#include <cmath>

#include "base/maths/range.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_weights.h"
#include "diagnose/prove/blind_changes.h"
#include "diagnose/say/claims.h"

namespace hydro::diagnose {

namespace {

// Noise units, squared: what a model leaves beside the noise is no larger than the noise itself. Less cannot be asked for: the noise is
// known to some 10 %, and starts and values are estimates.
constexpr double kNoiseAndAsMuchAgain = 2;
// Noise units, over whole runs, whose residuals are many: the noise is known to some 10 %.
constexpr double kWholeRunsAtTheNoise = 1.15;
// Of the squared gap above the noise, where all sensors are exact.
constexpr double kNearlyNothing = 0.01;

// The horizon with a gap that is nearest to 0.4 s, by its factor; null where no horizon has one.
const HorizonGap* DecidingHorizon(const Diagnosis& d) {
  const HorizonGap* near = nullptr;
  const auto away = [](const HorizonGap& one) { return std::abs(std::log(one.seconds / kHorizon)); };
  for (const HorizonGap& one : d.horizons) {
    if (!std::isfinite(one.typical.after)) continue;
    if (near == nullptr || away(one) < away(*near)) near = &one;
  }
  return near;
}

// What a gap that is not above `limit` leaves; where all sensors are exact, what is left counts beside what there was.
bool IsClosed(const BeforeAfter& gap, double limit, bool exact) {
  const double left = gap.after * gap.after - 1, before = gap.before * gap.before - 1;
  return gap.after <= limit || (exact && left <= kNearlyNothing * before);
}

// The first horizon that leaves more than noise; null: none. Errors of values grow at most as fast as the time: what is left beside the
// noise may be as many times larger as a longer horizon is.
const HorizonGap* OpenHorizon(const Diagnosis& d, const HorizonGap& near, bool exact) {
  const double beside = std::sqrt(kNoiseAndAsMuchAgain - 1);
  const auto open = std::find_if(d.horizons.begin(), d.horizons.end(), [&](const HorizonGap& one) {
    if (one.seconds < near.seconds || !std::isfinite(one.typical.after)) return false;
    return !IsClosed(one.typical, std::hypot(1, beside * one.seconds / near.seconds), exact);
  });
  return open == d.horizons.end() ? nullptr : &*open;
}

bool IsGapClosed(const Diagnosis& d, const Proof& proof, bool exact) {
  const bool whole =
      IsClosed(d.held_out, kWholeRunsAtTheNoise, exact) && IsClosed(d.fit, kWholeRunsAtTheNoise, exact);
  const HorizonGap* near = proof.OnWindows() ? DecidingHorizon(d) : nullptr;
  if (near == nullptr) return whole;
  // That nothing is missing has to hold over whole runs too, where the model can follow them: what is slow shows in no window.
  const bool found = !proof.Found().changes.empty() || !proof.Found().Free().empty();
  const bool follows = std::isfinite(d.held_out.after + d.fit.after);
  if (!found && follows && !whole) return false;
  return OpenHorizon(d, *near, exact) == nullptr;
}

// How much of its score a set owes to the effect; nothing where it does not have it, or the rest was not tried.
double OwedTo(const std::string& id, const ScoredSet& one, const std::vector<ScoredSet>& scores) {
  ChangeSet rest = one.set;
  std::erase_if(rest, [&](const std::string& change) { return EffectOf(change) == id; });
  if (rest.size() == one.set.size()) return 0;
  const auto same =
      std::find_if(scores.begin(), scores.end(), [&](const ScoredSet& other) { return other.set == rest; });
  return rest.empty() ? one.score : same == scores.end() ? 0 : one.score - same->score;
}

// Of the balances: that they do not deny it. One in twenty, by weight, or as far below the likeliest set as weights are tempered: what
// simulation refutes may have led.
bool IsSpokenFor(const std::string& id, const Diagnosis& d, const std::vector<ScoredSet>& scores) {
  constexpr double kAWord = 0.05;
  double weight = 0;
  for (const WeightedSet& one : d.explanations) {
    const bool has = std::any_of(one.changes.begin(), one.changes.end(),
                                 [&](const std::string& change) { return EffectOf(change) == id; });
    weight += has ? one.weight : 0;
  }
  return weight >= kAWord || std::any_of(scores.begin(), scores.end(), [&](const ScoredSet& one) {
           const double least = scores.front().score + kTemperature * std::log(kAWord);  // the best first
           return one.score > least && OwedTo(id, one, scores) > 0;
         });
}

// Whether something was found that simulation alone speaks for, though balances see all of the fitted runs.
bool HasOneWitness(const Diagnosis& d, const std::vector<ScoredSet>& scores) {
  if (d.effects.empty() || d.explanations.empty()) return false;
  const auto said = [&](const std::string& id) { return IsSpokenFor(id, d, scores); };
  return std::none_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& effect) {
    if (IsUnseenByBalances(effect.id) || said(effect.id)) return true;
    // Where other values do as well, not even the windows say that anything is missing.
    const auto values = [](const std::string& tied) { return tied.find('.') == std::string::npos; };
    return std::none_of(effect.tied_with.begin(), effect.tied_with.end(), values) &&
           std::any_of(effect.tied_with.begin(), effect.tied_with.end(), said);
  });
}

// Whether all that was found are times of a sample or two: means over a sample and filters make the signals late, or the command early.
// The balances allow for that, a simulation does not, so that what it alone speaks for is the recorder's.
bool IsTheRecorders(const Diagnosis& d, double sample) {
  constexpr double kSamples = 2;
  return std::all_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& effect) {
    const model::EffectInfo* info = model::FindEffect(effect.id);
    return info != nullptr && !effect.id.starts_with("sensor.") &&
           std::any_of(
               info->parameters.begin(), info->parameters.end(), [&](const model::ParameterInfo& parameter) {
                 return parameter.role == model::Role::kTime &&
                        std::any_of(
                            effect.parameters.begin(), effect.parameters.end(), [&](const Estimated& one) {
                              return one.name == parameter.name && std::abs(one.value) <= kSamples * sample;
                            });
               });
  });
}

}  // namespace

ComparedGap GapToCompare(const Diagnosis& d, const Proof& proof) {
  const HorizonGap* near = proof.OnWindows() ? DecidingHorizon(d) : nullptr;
  if (near == nullptr) return {d.held_out, 0};
  if (!IsOpen(d.verdict)) return {near->typical, near->seconds};
  // A gap at the noise would deny an open verdict: what is open may show over longer predictions only, over whole runs or in the fitted ones.
  const HorizonGap* open = OpenHorizon(d, *near, false);
  if (open != nullptr) return {open->typical, open->seconds};
  if (!d.closures.empty()) return {near->typical, near->seconds, true};
  if (d.held_out.after > kWholeRunsAtTheNoise) return {d.held_out, 0};
  if (d.fit.after > kWholeRunsAtTheNoise) return {d.fit, 0, false, true};
  return {near->typical, near->seconds, true};
}

bool IsWorse(const BeforeAfter& gap) {
  constexpr double kNoticeable = 1.01;
  return std::isfinite(gap.before) && std::isfinite(gap.after) && gap.after > kNoticeable * gap.before;
}

bool ExactSensors(const std::vector<const RunData*>& runs) {
  constexpr double kExact = 2e-4;
  for (const RunData* run : runs) {
    for (const SignalData& signal : run->signals) {
      const double size = maths::RangeOf(signal.values).size();
      if (size > 0 && signal.noise > kExact * size) return false;
    }
  }
  return true;
}

Verdict VerdictOn(const Diagnosis& d, const Proof& proof, const std::vector<ScoredSet>& scores,
                  bool exact_sensors, double sample) {
  const bool one_witness = HasOneWitness(d, scores);
  // Other values of a model that leaves nothing but noise are no finding, unless one of them is surely another.
  const bool values = proof.OnWindows() && !proof.Found().Free().empty() &&
                      !(GapToCompare(d, proof).gap.before <= std::sqrt(kNoiseAndAsMuchAgain));
  const bool something = !d.effects.empty() || !d.parameters.empty() || !d.closures.empty() || values;
  // A curve is no cause: what it closes stays unexplained.
  if (!d.closures.empty() && d.effects.empty()) return Verdict::kUnexplained;
  if (!IsGapClosed(d, proof, exact_sensors) || !d.closures.empty())
    return something && !one_witness ? Verdict::kPartly : Verdict::kUnexplained;
  if (!something) return Verdict::kNothingMissing;
  if (d.effects.empty()) return Verdict::kParameters;
  if (one_witness && IsTheRecorders(d, sample)) return Verdict::kUnexplained;
  const bool tied = std::any_of(d.effects.begin(), d.effects.end(),
                                [](const FoundEffect& effect) { return !effect.tied_with.empty(); });
  return tied ? Verdict::kTied : Verdict::kNamed;
}

}  // namespace hydro::diagnose
