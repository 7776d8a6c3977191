#include "diagnose/say/judgement.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "diagnose/balances/effect_variants.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_weights.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/prove/blind_changes.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/say/claims.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

// In noise units, over whole runs, which have many residuals: the noise is known to about 10 %.
constexpr double kWholeRunsAtTheNoise = 1.15;
// As a fraction of the squared gap above the noise. No machine's equations are true to better than a
// hundredth, so what is left of a gap beyond that is no finding, however fine the sensors are. Where all of
// them are exact, a tenth is as good: integrals of values that are off in the fourth digit show.
constexpr double kNearlyNothing = 1e-4, kNearlyNothingOfExact = 0.01;

// The horizon with a gap that is nearest to 0.4 s, by their ratio; null where no horizon has one.
const HorizonGap* DecidingHorizon(const Diagnosis& d) {
  const HorizonGap* near = nullptr;
  const auto away = [](const HorizonGap& one) { return std::abs(std::log(one.seconds / kHorizon)); };
  for (const HorizonGap& one : d.horizons) {
    if (!std::isfinite(one.typical.after)) continue;
    if (near == nullptr || away(one) < away(*near)) near = &one;
  }
  return near;
}

// Whether a gap is closed: it is not above `limit` times the noise that the samples show, or next to nothing
// is left of what there was before.
bool IsClosed(const Diagnosis& d, const BeforeAfter& gap, double limit, bool exact) {
  const double left = gap.after * gap.after - 1, before = gap.before * gap.before - 1;
  return gap.after <= limit * d.noise_shown ||
         left <= (exact ? kNearlyNothingOfExact : kNearlyNothing) * before;
}

// What may be left over a time that is longer than another by this factor. Errors of values grow at most in
// proportion to time, so the remainder beside the noise may be larger by that factor.
double MayBeLeft(double times) { return std::hypot(1, std::sqrt(kNoiseAndAsMuchAgain - 1) * times); }

// The first horizon that leaves more than noise; null: none.
const HorizonGap* OpenHorizon(const Diagnosis& d, const HorizonGap& near, bool exact) {
  const auto open = std::ranges::find_if(d.horizons, [&](const HorizonGap& one) {
    if (one.seconds < near.seconds || !std::isfinite(one.typical.after)) return false;
    return !IsClosed(d, one.typical, MayBeLeft(one.seconds / near.seconds), exact);
  });
  return open == d.horizons.end() ? nullptr : &*open;
}

bool IsGapClosed(const Diagnosis& d, const Proof& proof, const RunsJudged& runs) {
  const auto whole = [&](double limit) {
    return IsClosed(d, d.held_out, limit, runs.exact_sensors) &&
           IsClosed(d, d.fit, limit, runs.exact_sensors);
  };
  const HorizonGap* near = proof.OnWindows() ? DecidingHorizon(d) : nullptr;
  if (near == nullptr) return whole(kWholeRunsAtTheNoise);
  // "Nothing is missing" has to hold over whole runs too, where the model can follow them, because slow
  // effects show in no window. But an axis that integrates and friction that lets go a little later carry the
  // smallest error on, and an unstable motion multiplies it.
  const bool found = !proof.Found().changes.empty() || !proof.Found().Free().empty();
  const bool follows = std::isfinite(d.held_out.after + d.fit.after);
  // A model that follows whole runs to the noise follows their windows too, from the right starts. But a
  // window's start does not say what an effect remembers, as where in its play a load is.
  if (follows && std::max(d.held_out.after, d.fit.after) <= kWholeRunsAtTheNoise * d.noise_shown) return true;
  const double left = std::max(kWholeRunsAtTheNoise, MayBeLeft(runs.longest / near->seconds * runs.growth));
  if (!found && follows && !whole(left)) return false;
  return OpenHorizon(d, *near, runs.exact_sensors) == nullptr;
}

// How much of a set's score is due to the effect; nothing where the set does not have it, or where the set
// without it was not tried.
double OwedTo(const std::string& id, const ScoredSet& one, const std::vector<ScoredSet>& scores) {
  ChangeSet rest = one.set;
  std::erase_if(rest, [&](const std::string& change) { return EffectOf(change) == id; });
  if (rest.size() == one.set.size()) return 0;
  const auto same = std::ranges::find_if(scores, [&](const ScoredSet& other) { return other.set == rest; });
  return rest.empty() ? one.score : same == scores.end() ? 0 : one.score - same->score;
}

// Whether the balances do not deny the effect: one in twenty, by weight, or as far below the likeliest set as
// weights are tempered, because simulation may refute the leading set.
bool IsSpokenFor(const std::string& id, const Diagnosis& d, const std::vector<ScoredSet>& scores) {
  constexpr double kAWord = 0.05;
  double weight = 0;
  for (const WeightedSet& one : d.explanations) {
    const bool has =
        std::ranges::any_of(one.changes, [&](const std::string& change) { return EffectOf(change) == id; });
    weight += has ? one.weight : 0;
  }
  return weight >= kAWord || std::ranges::any_of(scores, [&](const ScoredSet& one) {
           const double least = scores.front().score + kTemperature * std::log(kAWord);  // the best first
           return one.score > least && OwedTo(id, one, scores) > 0;
         });
}

// Whether something was found for which only simulation speaks, although balances see all of the fitted runs.
bool HasOneWitness(const Diagnosis& d, const std::vector<ScoredSet>& scores) {
  if (d.effects.empty() || d.explanations.empty()) return false;
  const auto said = [&](const std::string& id) { return IsSpokenFor(id, d, scores); };
  return std::ranges::none_of(d.effects, [&](const FoundEffect& effect) {
    if (IsUnseenByBalances(effect.id) || said(effect.id)) return true;
    // Where other values do as well, even the windows do not say that anything is missing.
    const auto values = [](const std::string& tied) { return tied.find('.') == std::string::npos; };
    return std::ranges::none_of(effect.tied_with, values) && std::ranges::any_of(effect.tied_with, said);
  });
}

// Whether everything that was found is a time of a sample or two. Means over a sample and filters make the
// signals late, or the command early. The balances allow for that and a simulation does not, so if only
// simulation speaks for such a time, the recorder causes it.
bool IsTheRecorders(const Diagnosis& d, double sample) {
  return std::ranges::all_of(d.effects, [&](const FoundEffect& effect) {
    const model::EffectInfo* info = model::FindEffect(effect.id);
    return info != nullptr && !effect.id.starts_with("sensor.") &&
           std::ranges::any_of(info->parameters, [&](const model::ParameterInfo& parameter) {
             return parameter.role == model::Role::kTime &&
                    std::ranges::any_of(effect.parameters, [&](const Estimated& one) {
                      return one.name == parameter.name && std::abs(one.value) <= kRecorderSamples * sample;
                    });
           });
  });
}

// Whether some effect may as well be absent: 0 lies within the intervals of all its amounts. The fitted runs
// do not show it, and held-out windows alone name nothing: what is small and late, say, helps itself to a
// drift.
bool MayBeAbsent(const FoundEffect& effect) {
  const model::EffectInfo* info = model::FindEffect(effect.id);
  if (info == nullptr || IsUnseenByBalances(effect.id)) return false;
  size_t amounts = 0, none = 0;
  for (const model::ParameterInfo& parameter : info->parameters) {
    if (!IsAmount(parameter)) continue;
    for (const Estimated& one : effect.parameters) {
      if (one.name != parameter.name || !std::isfinite(one.low) || !std::isfinite(one.high)) continue;
      ++amounts;
      if (one.low <= 0 && one.high >= 0) ++none;
    }
  }
  return amounts > 0 && none == amounts;
}

}  // namespace

ComparedGap GapToCompare(const Diagnosis& d, const Proof& proof) {
  const HorizonGap* near = proof.OnWindows() ? DecidingHorizon(d) : nullptr;
  if (near == nullptr) return {d.held_out, 0};
  if (!IsOpen(d.verdict)) return {near->typical, near->seconds};
  // An open verdict should not state a gap at the noise: what is open may show only over longer predictions,
  // over whole runs or in the fitted runs.
  const HorizonGap* open = OpenHorizon(d, *near, false);
  if (open != nullptr) return {open->typical, open->seconds};
  if (!d.closures.empty()) return {near->typical, near->seconds, true};
  if (!IsClosed(d, d.held_out, kWholeRunsAtTheNoise, false)) return {d.held_out, 0};
  if (!IsClosed(d, d.fit, kWholeRunsAtTheNoise, false)) return {d.fit, 0, false, true};
  return {near->typical, near->seconds, true};
}

bool IsWorse(const BeforeAfter& gap) {
  constexpr double kNoticeable = 1.01;
  return std::isfinite(gap.before) && std::isfinite(gap.after) && gap.after > kNoticeable * gap.before;
}

RunsJudged JudgedBy(const std::vector<const RunData*>& runs, double growth) {
  RunsJudged judged{ExactSensors(runs), SampleInterval(runs), 0, growth};
  for (const RunData* run : runs) judged.longest = std::max(judged.longest, run->duration());
  return judged;
}

bool ExactSensors(const std::vector<const RunData*>& runs) {
  constexpr double kExact = 1.01 * kNoNoise;  // of a range that may have lost its spikes
  for (const RunData* run : runs) {
    for (const SignalData& signal : run->signals) {
      const double size = maths::RangeOf(signal.values).size();
      if (size > 0 && signal.noise > kExact * size) return false;
    }
  }
  return true;
}

bool MayBeTheRecorders(const Diagnosis& d, const std::vector<ScoredSet>& scores, const RunsJudged& runs) {
  return HasOneWitness(d, scores) && IsTheRecorders(d, runs.sample);
}

Verdict VerdictOn(const Diagnosis& d, const Proof& proof, const std::vector<ScoredSet>& scores,
                  const RunsJudged& runs) {
  const bool one_witness = HasOneWitness(d, scores);
  // If the model as given leaves only noise, other values are no finding, unless one of them has clearly
  // changed.
  const bool values = !proof.Found().Free().empty() &&
                      !(GapToCompare(d, proof).gap.before <= std::sqrt(kNoiseAndAsMuchAgain) * d.noise_shown);
  const bool changed = std::ranges::any_of(d.parameters, [](const ChangedParameter& one) {
    return ShortNumber(one.fitted.value) != ShortNumber(one.model);
  });
  const bool something = !d.effects.empty() || changed || !d.closures.empty() || values;
  // A curve is no cause, so what it closes stays unexplained.
  if (!d.closures.empty() && d.effects.empty()) return Verdict::kUnexplained;
  if (!(proof.given_suffices || IsGapClosed(d, proof, runs)) || !d.closures.empty())
    return something && !one_witness ? Verdict::kPartly : Verdict::kUnexplained;
  if (!something) return Verdict::kNothingMissing;
  if (d.effects.empty()) return Verdict::kParameters;
  if (MayBeTheRecorders(d, scores, runs)) return Verdict::kUnexplained;
  const bool tied =
      std::ranges::any_of(d.effects, [](const FoundEffect& effect) { return !effect.tied_with.empty(); });
  if (tied) return Verdict::kTied;
  return std::ranges::any_of(d.effects, MayBeAbsent) ? Verdict::kUnexplained : Verdict::kNamed;
}

}  // namespace hydro::diagnose
