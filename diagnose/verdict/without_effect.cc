#include "diagnose/verdict/without_effect.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "diagnose/prove/window_gaps.h"
#include "diagnose/verdict/evidence.h"

namespace hydro::diagnose {

namespace {

// What was tried with the same changes and the same free values; null when nothing was.
const Explanation* Find(const std::vector<const Explanation*>& tried, const Hypothesis& hypothesis) {
  const Explanation* found = nullptr;
  for (const Explanation* one : tried) {
    if (!one->fitted.ok() || one->blocks.sums.empty()) continue;
    if (!one->fitted.hypothesis.FreesTheSame(hypothesis) || !SameChanges(one->fitted.hypothesis, hypothesis))
      continue;
    if (found == nullptr || one->squared_gap() < found->squared_gap()) found = one;
  }
  return found;
}

// Of the squared gap above the noise that there is to take, what comes back. A model that cannot follow the runs leaves nothing to
// compare with.
double Part(double to_take, double with, double without) {
  if (!(to_take > 1) || !std::isfinite(to_take) || !std::isfinite(without))
    return std::numeric_limits<double>::quiet_NaN();
  return std::clamp((without - std::max(1.0, with)) / (to_take - 1), 0.0, 1.0);
}

bool HasEffects(const Explanation& one, const std::vector<Change>& effects) {
  const std::vector<Change> own = EffectsOf(one);
  return std::is_permutation(own.begin(), own.end(), effects.begin(), effects.end());
}

// The least squared gap of what was tried with exactly these effects; infinite where nothing was.
double LeastWith(const std::vector<Explanation>& tried, const std::vector<Change>& effects) {
  double least = std::numeric_limits<double>::infinity();
  for (const Explanation& one : tried) {
    if (HasEffects(one, effects) && !one.blocks.sums.empty()) least = std::min(least, one.held_out_gap());
  }
  return least;
}

// The typical squared gap of the windows that judge, with the hypothesis fitted to the others; NaN where it cannot be fitted.
double FittedWindowsGap(const SearchContext& context, const WindowTrials& windows,
                        const Hypothesis& hypothesis, const std::vector<model::StartState>& starts) {
  const Fitted fitted = Fit(hypothesis, windows.fitted, starts, FitToCompare(context.jobs));
  if (!fitted.ok()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<WindowGap> gaps(windows.choosing.size());
  ParallelFor(gaps.size(), context.jobs,
              [&](size_t w) { gaps[w] = GapOf(fitted.hypothesis.model, *windows.choosing[w]); });
  return TypicalGap(gaps);
}

double ShareOnWindows(const SearchContext& context, const WindowTrials& windows, const Explanation& near,
                      const Change& change) {
  std::vector<Change> others = EffectsOf(near);
  std::erase(others, change);
  const double with = near.held_out_gap();
  double without = LeastWith(windows.tried, others);
  if (!std::isfinite(without)) {
    without = FittedWindowsGap(context, windows, Without(near.fitted.hypothesis, change, context.given),
                               StartsOf(near.fitted));
  }
  const double of_values = LeastWith(windows.tried, {});
  return Part(std::isfinite(of_values) ? of_values : without, with, without);
}

}  // namespace

std::vector<Change> EffectsOf(const Explanation& one) {
  std::vector<Change> effects;
  for (const Change& change : one.changes()) {
    if (!change.effect.empty()) effects.push_back(change);
  }
  return effects;
}

double ShareOf(const SearchContext& context, const SearchResult& search, const WindowTrials& windows,
               const Change& change) {
  const Explanation* near = windows.decide ? OnWindowsOf(windows, search.best.fitted.hypothesis) : nullptr;
  if (near != nullptr) return ShareOnWindows(context, windows, *near, change);
  const Explanation without = FitWithout(context, search, change);
  if (!without.fitted.ok()) return std::numeric_limits<double>::quiet_NaN();
  return Part(search.given.held_out.squared_gap(), search.best.held_out.squared_gap(),
              without.held_out.squared_gap());
}

double TypicalWithout(const WindowTrials& windows, const Explanation& best,
                      const std::vector<Change>& effects) {
  std::vector<Change> others = EffectsOf(best);
  for (const Change& change : effects) std::erase(others, change);
  return std::sqrt(LeastWith(windows.tried, others));
}

std::vector<std::string> Amounts(const model::EffectInfo& effect) {
  using model::Role;
  std::vector<std::string> names;
  for (const model::ParameterInfo& parameter : effect.parameters) {
    const bool of_form = parameter.role == Role::kPhase || parameter.role == Role::kPeriods ||
                         parameter.role == Role::kFrequency || parameter.is_name();
    const bool from_none =
        std::find(parameter.starts.begin(), parameter.starts.end(), 0.0) != parameter.starts.end();
    if (!of_form && (from_none || parameter.role == Role::kTime)) names.push_back(parameter.name);
  }
  return names;
}

bool MayBeNone(const Hypothesis& hypothesis, const Change& change, const std::vector<Interval>& intervals) {
  constexpr double kNearlyNone = 0.1;
  const std::vector<FreeParameter> free = hypothesis.Free();
  bool any = false;
  for (const std::string& name : Amounts(*model::FindEffect(change.effect))) {
    for (size_t i = 0; i < free.size(); ++i) {
      if (free[i].name != change.effect + "." + name) continue;
      any = true;
      const bool none = free[i].logarithmic ? intervals[i].low < kNearlyNone * free[i].value
                                            : intervals[i].low <= 0 && intervals[i].high >= 0;
      if (!none) return false;
    }
  }
  return any;
}

Profile ProfileAtNone(const std::vector<const RunData*>& runs, const Fitted& with, const Fitted& without,
                      const Change& change) {
  const double numbers =
      static_cast<double>(with.hypothesis.Free().size() - without.hypothesis.Free().size());
  const boost::math::chi_squared distribution(std::max(1.0, numbers));
  const double limit = boost::math::quantile(distribution, 0.95) * std::max(1.0, with.squared_gap()) *
                       CorrelationOf(runs, with);
  const double fall = without.sum - with.sum;
  Profile profile;
  profile.shows = fall > limit;
  // Between none and the best value the profile is taken to be a parabola.
  if (profile.shows && Amounts(*model::FindEffect(change.effect)).size() == 1) {
    profile.lowest = 1 - std::sqrt(limit / fall);
  }
  return profile;
}

Explanation FitWithout(const SearchContext& context, const SearchResult& search, const Change& change) {
  const Hypothesis less = Without(search.best.fitted.hypothesis, change, context.given);
  std::vector<const Explanation*> tried = PointersToAll(search.tried);
  tried.push_back(&search.given);
  if (const Explanation* there = Find(tried, less)) return *there;
  return Explain(context, less, StartsOf(search.best.fitted), FineFit(context.jobs));
}

}  // namespace hydro::diagnose
