#include "diagnose/verdict/without_effect.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "diagnose/search/refits.h"
#include "diagnose/search/window_search.h"
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

double Part(double given, double with, double without) {
  if (!(given > 1) || !std::isfinite(without)) return std::numeric_limits<double>::quiet_NaN();
  return std::clamp((without - std::max(1.0, with)) / (given - 1), 0.0, 1.0);
}

}  // namespace

double ShareOf(const SearchContext& context, const SearchResult& search, const WindowTrials& windows,
               const Change& change) {
  const Explanation* near = Find(PointersToAll(windows.tried), search.best.fitted.hypothesis);
  if (near == nullptr) near = BestOf(windows.tried, ClaimOf(search.best.fitted.hypothesis));
  const Explanation* given = BestOf(windows.tried, kAsGiven);
  if (near == nullptr || given == nullptr) {
    const Explanation without = FitWithout(context, search, change);
    if (!without.fitted.ok()) return std::numeric_limits<double>::quiet_NaN();
    return Part(search.given.held_out.squared_gap(), search.best.held_out.squared_gap(),
                without.held_out.squared_gap());
  }
  const Hypothesis less = Without(near->fitted.hypothesis, change, context.given);
  Explanation fitted;
  const Explanation* without = Find(PointersToAll(windows.tried), less);
  if (without == nullptr) {
    const SearchContext on_windows = OnWindows(context, windows.fitted, windows.choosing);
    fitted = Explain(on_windows, less, StartsOf(near->fitted), FitToCompare(context.jobs));
    without = &fitted;
  }
  if (!without->fitted.ok()) return std::numeric_limits<double>::quiet_NaN();
  return Part(given->held_out.squared_gap(), near->held_out.squared_gap(), without->held_out.squared_gap());
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
