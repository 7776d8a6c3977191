#include "diagnose/verdict/found.h"

#include <algorithm>

#include "base/word_list.h"
#include "diagnose/closure/closure.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/verdict/found_values.h"
#include "diagnose/verdict/plausible.h"
#include "diagnose/verdict/rivals.h"
#include "diagnose/verdict/without_effect.h"

namespace hydro::diagnose {

namespace {

// The fit that shows how well numbers are known: to windows where these decide, else to the whole runs.
struct Basis {
  const Fitted& fitted;
  const std::vector<const RunData*>& runs;
};

Basis BasisOf(const SearchContext& context, const Explanation& best, const WindowTrials& windows) {
  if (windows.decide && SameChanges(windows.best.hypothesis, best.fitted.hypothesis)) {
    return {windows.best, windows.fitted};
  }
  return {best.fitted, context.runs};
}

// Around the explanation's values, as wide as its basis says.
std::vector<Interval> IntervalsOf(const SearchContext& context, const Explanation& one,
                                  const WindowTrials& windows) {
  const std::vector<FreeParameter> free = one.fitted.hypothesis.Free();
  if (free.empty()) return {};
  const Basis basis = BasisOf(context, one, windows);
  std::vector<Interval> intervals = Intervals(basis.fitted, basis.runs, context.jobs);
  // Values of whole runs, with what windows say of them: the interval holds both.
  for (size_t i = 0; i < free.size(); ++i) {
    intervals[i].low = std::min(intervals[i].low, free[i].value);
    intervals[i].high = std::max(intervals[i].high, free[i].value);
  }
  return intervals;
}

// The fit of the basis without the change; fails where windows have not tried it.
Fitted WithoutIt(const SearchContext& context, const SearchResult& search, const WindowTrials& windows,
                 const Change& change) {
  const Explanation& best = search.best;
  if (&BasisOf(context, best, windows).fitted == &best.fitted)
    return FitWithout(context, search, change).fitted;
  for (const Explanation& one : windows.tried) {
    const Change* more = best.fitted.hypothesis.OneBeyond(one.fitted.hypothesis);
    const bool less = one.changes().size() + 1 == best.changes().size() && more != nullptr && *more == change;
    if (less && one.fitted.ok() && one.fitted.hypothesis.FreesTheSame(best.fitted.hypothesis))
      return one.fitted;
  }
  Fitted none;
  none.failure = "not tried";
  return none;
}

// Where the interval of an effect's single amount reaches to none of it though the runs show some, the interval
// is that of the profile on this side.
void RaiseFromNone(const Hypothesis& hypothesis, const Change& change, double lowest,
                   std::vector<Interval>* intervals) {
  const std::vector<FreeParameter> free = hypothesis.Free();
  const std::vector<std::string> amounts = Amounts(*model::FindEffect(change.effect));
  for (size_t i = 0; i < free.size() && amounts.size() == 1; ++i) {
    if (free[i].name != change.effect + "." + amounts.front()) continue;
    const double end = lowest * free[i].value;
    Interval& interval = (*intervals)[i];
    (free[i].value > 0 ? interval.low : interval.high) =
        free[i].value > 0 ? std::max(interval.low, end) : std::min(interval.high, end);
  }
}

FoundEffect Describe(const Change& change, const std::vector<FreeParameter>& free,
                     const std::vector<Interval>& intervals) {
  const model::EffectInfo& info = *model::FindEffect(change.effect);
  FoundEffect found;
  found.id = info.id;
  found.summary = info.summary;
  found.equation = info.equation;
  for (const auto& [name, value] : change.names) found.names.push_back(name + " = " + value);
  for (const model::ParameterInfo& parameter : info.parameters) {
    for (size_t i = 0; i < free.size(); ++i) {
      if (free[i].name != info.id + "." + parameter.name) continue;
      found.parameters.push_back(
          {parameter.name, free[i].value, intervals[i].low, intervals[i].high, free[i].unit});
    }
  }
  return found;
}

// The weight of all claims that have the change.
double WeightOf(const Change& change, const std::map<std::string, double>& weights) {
  const std::string label = " + " + change.Label() + " + ";
  double sum = 0;
  for (const auto& [claim, weight] : weights) {
    if ((" + " + claim + " + ").find(label) != std::string::npos) sum += weight;
  }
  return std::min(1.0, sum);
}

// The closures, with the typical gap over windows with and without them.
std::vector<Closure> DescribeClosures(const WindowTrials& windows, const Explanation& best,
                                      const std::vector<Interval>& intervals) {
  std::vector<Closure> closures = FoundClosures(best.fitted.hypothesis, intervals);
  if (closures.empty() || !windows.decide) return closures;
  std::vector<Change> curves = EffectsOf(best);
  std::erase_if(curves, [](const Change& change) { return !IsClosureEffect(change.effect); });
  for (Closure& closure : closures) {
    closure.before = TypicalWithout(windows, best, curves);
    closure.after = TypicalWithout(windows, best, {});
    closure.seconds = kHorizon;
  }
  return closures;
}

// Of the gap that the model's own values leave. An effect that takes less is not worth a name, whatever the scatter between windows.
constexpr double kLeastShareOfAnEffect = 0.02;

// The best explanation over whole runs without the change, with the values that it has beside it; fails where it cannot follow them.
Explanation TakenAway(const SearchContext& context, const Explanation& best, const Change& change) {
  FitOptions held;
  held.most_iterations = 0;
  held.jobs = context.jobs;
  return Explain(context, Without(best.fitted.hypothesis, change, context.given), StartsOf(best.fitted),
                 held);
}

// Where windows decide, the proof has tried to do without each effect. What it needs for hardly any of the gap is dropped.
Kept KeepWhatWasProved(const SearchContext& context, const SearchResult& search,
                       const WindowTrials& windows) {
  Kept kept{search, {}};
  for (const Change& change : EffectsOf(search.best)) {
    if (EffectsOf(kept.search.best).size() < 2) break;
    if (!(ShareOf(context, kept.search, windows, change) < kLeastShareOfAnEffect)) continue;
    Explanation without = TakenAway(context, kept.search.best, change);
    if (without.fitted.ok()) kept.search.best = std::move(without);
  }
  return kept;
}

}  // namespace

Kept KeepWhatIsThere(const SearchContext& context, const SearchResult& search, const WindowTrials& windows) {
  if (windows.decide) return KeepWhatWasProved(context, search, windows);
  Kept kept{search, {}};
  bool dropped = true;
  while (dropped) {
    dropped = false;
    kept.doubts.clear();
    const Explanation& best = kept.search.best;
    const std::vector<Interval> intervals = IntervalsOf(context, best, windows);
    for (const Change& change : EffectsOf(best)) {
      if (!MayBeNone(best.fitted.hypothesis, change, intervals)) continue;
      Explanation without = FitWithout(context, kept.search, change);
      kept.search.tried.push_back(without);  // it is asked for again
      if (without.fitted.ok() && !Material(without.held_out_gap(), best.held_out_gap())) {
        kept.search.best = std::move(without);
        dropped = true;
        break;
      }
      const bool shows =
          without.fitted.ok() && ProfileAtNone(context.runs, best.fitted, without.fitted, change).shows;
      if (!shows) kept.doubts.push_back("the interval of " + change.Label() + " includes none of it");
    }
  }
  return kept;
}

std::vector<model::ModelDescription> DescribeFound(const SearchContext& context, const Explanation& refit,
                                                   const WindowTrials& windows,
                                                   const std::map<std::string, double>& weights, Kept* kept,
                                                   Diagnosis* d) {
  const Explanation& best = kept->search.best;
  const std::vector<FreeParameter> free = best.fitted.hypothesis.Free();
  std::vector<Interval> intervals = IntervalsOf(context, best, windows);
  const Basis basis = BasisOf(context, best, windows);
  std::vector<model::ModelDescription> rivals = {best.fitted.hypothesis.model};
  for (const Change& change : EffectsOf(best)) {
    if (IsClosureEffect(change.effect)) continue;
    if (MayBeNone(best.fitted.hypothesis, change, intervals)) {
      const Fitted without = WithoutIt(context, kept->search, windows, change);
      if (without.ok()) {
        const Profile profile = ProfileAtNone(basis.runs, basis.fitted, without, change);
        if (profile.shows) RaiseFromNone(best.fitted.hypothesis, change, profile.lowest, &intervals);
      }
    }
    FoundEffect found = Describe(change, free, intervals);
    found.share = ShareOf(context, kept->search, windows, change);
    found.weight = WeightOf(change, weights);
    for (const Rival& rival : RivalsOf(change, kept->search, refit, windows, weights)) {
      found.tied_with.push_back(rival.label);
      rivals.push_back(rival.explanation->fitted.hypothesis.model);
    }
    d->effects.push_back(std::move(found));
  }
  d->closures = DescribeClosures(windows, best, intervals);
  DescribeValues(context, best, intervals, d);
  const std::vector<std::string> implausible =
      Implausible(d->parameters, d->effects, context.given.parameters);
  if (!implausible.empty()) kept->doubts.push_back("no rig is likely to have " + Enumerated(implausible));
  return rivals;
}

}  // namespace hydro::diagnose
