#include "diagnose/verdict/judgement.h"

#include <algorithm>
#include <cmath>

#include "diagnose/fit/comparison.h"

namespace hydro::diagnose {

namespace {

// Noise units, squared: what a model leaves beside the noise is no larger than the noise itself. Less cannot be asked for: the noise is
// known to some 10 %, and starts and values are estimates.
constexpr double kNoiseAndAsMuchAgain = 2;

// The horizon with a gap that is nearest to 0.4 s, by its factor; null where no horizon has one.
const HorizonGap* NearHorizon(const Diagnosis& d) {
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
  return gap.after <= limit || (exact && Closed(gap.before * gap.before, gap.after * gap.after, exact));
}

// Whether only noise is left on the windows. Errors of values grow at most as fast as the time: what is left beside the noise may be
// as many times larger as a longer horizon is.
bool WindowsAreClosed(const Diagnosis& d, const HorizonGap& near, bool exact) {
  const double beside = std::sqrt(kNoiseAndAsMuchAgain - 1);
  return std::all_of(d.horizons.begin(), d.horizons.end(), [&](const HorizonGap& one) {
    if (one.seconds < near.seconds || !std::isfinite(one.typical.after)) return true;
    return IsClosed(one.typical, std::hypot(1, beside * one.seconds / near.seconds), exact);
  });
}

// Whether whole runs are predicted to the noise, both fitted and held out.
bool WholeRunsAreClosed(const Kept& kept, bool exact) {
  const Explanation& given = kept.search.given;
  const Explanation& best = kept.search.best;
  return Closed(given.held_out_gap(), best.held_out_gap(), exact) &&
         Closed(given.squared_gap(), best.squared_gap(), exact);
}

bool IsGapClosed(const Kept& kept, const WindowTrials& windows, const Diagnosis& d, bool exact) {
  const HorizonGap* near = windows.decide ? NearHorizon(d) : nullptr;
  if (near == nullptr) return WholeRunsAreClosed(kept, exact);
  // That nothing is missing has to hold over whole runs too, where the model can follow them: what is slow shows in no window.
  const bool found =
      !kept.search.best.changes().empty() || !kept.search.best.fitted.hypothesis.Free().empty();
  const bool follows = std::isfinite(kept.search.best.held_out_gap() + kept.search.best.squared_gap());
  if (!found && follows && !WholeRunsAreClosed(kept, exact)) return false;
  return WindowsAreClosed(d, *near, exact);
}

// Whether half of the squared gap is taken. A model that cannot follow the runs has no gap to compare with: following them is
// material.
bool TakesHalf(const Diagnosis& d, const BeforeAfter& gap) {
  constexpr double kPart = 0.5;
  if (!std::isfinite(gap.after)) return false;
  double to_beat = gap.before;
  const bool refit_counts = !d.effects.empty() || !d.closures.empty();
  if (refit_counts && std::isfinite(gap.refit_only) && !(to_beat < gap.refit_only)) to_beat = gap.refit_only;
  if (!std::isfinite(to_beat)) return true;
  const double before = to_beat * to_beat - 1;
  return before > 0 && gap.after * gap.after - 1 < (1 - kPart) * before;
}

}  // namespace

ComparedGap GapToCompare(const Diagnosis& d, const WindowTrials& windows) {
  const HorizonGap* near = windows.decide ? NearHorizon(d) : nullptr;
  return near == nullptr ? ComparedGap{d.held_out, 0} : ComparedGap{near->typical, near->seconds};
}

bool IsWorse(const BeforeAfter& gap) {
  constexpr double kNoticeable = 1.01;
  return std::isfinite(gap.before) && std::isfinite(gap.after) && gap.after > kNoticeable * gap.before;
}

bool TakesMaterialPart(const Diagnosis& d, const WindowTrials& windows) {
  if (windows.decide) return TakesHalf(d, GapToCompare(d, windows).gap);
  size_t material = TakesHalf(d, d.held_out) ? 1 : 0, simulated = 0;
  for (const HorizonGap& horizon : d.horizons) {
    material += TakesHalf(d, horizon.typical) ? 1 : 0;
    simulated += std::isfinite(horizon.typical.after) ? 1 : 0;
  }
  return material >= std::max<size_t>(simulated, 1);
}

Verdict VerdictOn(const SearchContext& context, const Kept& kept, const WindowTrials& windows,
                  const Diagnosis& d) {
  const Explanation& best = kept.search.best;
  // Other values of a model that leaves nothing but noise are no finding, unless one of them is surely another.
  const bool values = windows.decide && !best.fitted.hypothesis.Free().empty() &&
                      !(GapToCompare(d, windows).gap.before <= std::sqrt(kNoiseAndAsMuchAgain));
  const bool something = !d.effects.empty() || !d.parameters.empty() || !d.closures.empty() || values;
  const bool closed = IsGapClosed(kept, windows, d, ExactSensors(context.runs));
  if (!kept.doubts.empty() || (!closed && !windows.decide))
    return something && TakesMaterialPart(d, windows) ? Verdict::kPartly : Verdict::kUnexplained;
  // A curve is no cause: what it closes stays unexplained.
  if (!d.closures.empty() && d.effects.empty()) return Verdict::kUnexplained;
  if (!closed || !d.closures.empty()) return something ? Verdict::kPartly : Verdict::kUnexplained;
  if (!something) return Verdict::kNothingMissing;
  if (d.effects.empty()) return Verdict::kParameters;
  const bool tied = std::any_of(d.effects.begin(), d.effects.end(),
                                [](const FoundEffect& effect) { return !effect.tied_with.empty(); });
  return tied ? Verdict::kTied : Verdict::kNamed;
}

}  // namespace hydro::diagnose
