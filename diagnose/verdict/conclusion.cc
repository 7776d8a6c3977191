#include "diagnose/verdict/conclusion.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/locate/locate.h"
#include "diagnose/search/window_search.h"
#include "diagnose/verdict/evidence.h"
#include "diagnose/verdict/horizons.h"
#include "diagnose/verdict/next_experiment.h"
#include "diagnose/verdict/ranking.h"
#include "diagnose/verdict/run_curves.h"

namespace hydro::diagnose {

namespace {

// A rival is ruled out if it is worse by this many standard errors, block by block.
constexpr double kDistinguished = 2.5;
// A base parameter that has to move by more than this factor is implausible.
constexpr double kImplausible = 2.0;

struct Rival {
  Change change;
  const Explanation* explanation = nullptr;
};

// The changes that can replace one of `best` and do as well.
std::vector<Rival> Rivals(const std::vector<Explanation>& tried, const Explanation& best,
                          const Change& change) {
  std::vector<Rival> rivals;
  for (const Explanation& other : tried) {
    if (other.blocks.sums.empty() || other.changes().size() != best.changes().size()) continue;
    if (other.fitted.hypothesis.Has(change)) continue;
    const Change* instead = other.fitted.hypothesis.OneBeyond(best.fitted.hypothesis);
    if (instead == nullptr) continue;
    const double t = TValue(other.blocks, best.blocks);
    const double loss = other.held_out_gap() - best.held_out_gap();
    if (t > kDistinguished || loss > std::max(kLeastGain, 0.1 * (best.held_out_gap() - 1))) continue;
    const bool there =
        std::any_of(rivals.begin(), rivals.end(), [&](const Rival& had) { return had.change == *instead; });
    if (!there) rivals.push_back({*instead, &other});
  }
  return rivals;
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

ChangedParameter DescribeParameter(const FreeParameter& fitted, const Interval& interval,
                                   const model::ModelDescription& given) {
  ChangedParameter changed;
  changed.fitted = {fitted.name, fitted.value, interval.low, interval.high, fitted.unit};
  changed.model = given.parameters.*model::BaseParameters()[fitted.unknown.index].member;
  if (changed.model != 0) {
    const double ratio = fitted.value / changed.model;
    if (ratio > kImplausible || ratio < 1 / kImplausible) {
      changed.implausible = true;
      changed.why = "moves by a factor of " + ShortNumber(ratio, 3);
    }
  }
  return changed;
}

std::string Sentence(const Diagnosis& d) {
  const std::string gap = " (held-out gap " + ShortNumber(d.held_out.before, 3) + " to " +
                          ShortNumber(d.held_out.after, 3) + " noise units).";
  std::vector<std::string> names;
  for (const FoundEffect& effect : d.effects) {
    std::string name = effect.summary + " [" + effect.id + "]";
    if (!effect.tied_with.empty()) name += ", or " + Enumerated(effect.tied_with);
    names.push_back(name);
  }
  std::vector<std::string> parameters;
  for (const ChangedParameter& changed : d.parameters) {
    parameters.push_back(changed.fitted.name + " = " + ShortNumber(changed.fitted.value) + " instead of " +
                         ShortNumber(changed.model));
  }
  switch (d.verdict) {
    case Verdict::kNothingMissing:
      return "Nothing is missing: the model as given explains the data to " +
             ShortNumber(d.held_out.before, 3) + " noise units.";
    case Verdict::kParameters:
      return "The equations suffice with other values: " + Enumerated(parameters) + gap;
    case Verdict::kNamed:
      return "Missing: " + Enumerated(names) +
             (parameters.empty() ? "" : "; with " + Enumerated(parameters)) + gap;
    case Verdict::kTied:
      return "Missing, but these data cannot tell which: " + Enumerated(names) +
             (parameters.empty() ? "" : "; with " + Enumerated(parameters)) + gap;
    case Verdict::kPartly:
      return "Missing, but not all that is missing: " + Enumerated(names) +
             (parameters.empty() ? "" : "; with " + Enumerated(parameters)) +
             "; no other known effect takes as much of the gap, and what is left has another cause" + gap;
    case Verdict::kUnexplained: {
      const double before = d.held_out.before * d.held_out.before - 1;
      const double left = (d.held_out.after * d.held_out.after - 1) / before;
      return "Something is missing that no known effect explains" +
             (names.empty() ? std::string()
                            : "; the nearest is " + Enumerated(names) + ", which leaves " +
                                  ShortNumber(100 * left, 2) + " % of the squared gap") +
             gap;
    }
  }
  return "";
}

std::string WhyNext(const std::vector<FoundEffect>& effects) {
  for (const FoundEffect& effect : effects) {
    if (!effect.tied_with.empty())
      return "distinguishes " + effect.id + " from " + Enumerated(effect.tied_with);
  }
  return "";
}

BeforeAfter FitGaps(const Explanation& given, const Explanation& refit, const Explanation& best) {
  return {std::sqrt(given.squared_gap()), std::sqrt(refit.squared_gap()), std::sqrt(best.squared_gap())};
}

BeforeAfter HeldOutGaps(const Explanation& given, const Explanation& refit, const Explanation& best) {
  return {std::sqrt(given.held_out_gap()), std::sqrt(refit.held_out_gap()), std::sqrt(best.held_out_gap())};
}

// Fills in the effects and parameters found. Returns the models that do equally well, the best first.
std::vector<model::ModelDescription> DescribeFound(const SearchContext& context, const SearchResult& search,
                                                   Diagnosis* d) {
  const Explanation& best = search.best;
  const std::vector<FreeParameter> free = best.fitted.hypothesis.Free();
  const std::vector<Interval> intervals =
      free.empty() ? std::vector<Interval>{} : Intervals(best.fitted, context.runs, context.jobs);
  std::vector<model::ModelDescription> rivals = {best.fitted.hypothesis.model};
  for (const Change& change : best.changes()) {
    if (change.effect.empty()) continue;
    FoundEffect found = Describe(change, free, intervals);
    for (const Rival& rival : Rivals(search.tried, best, change)) {
      found.tied_with.push_back(rival.change.Label());
      rivals.push_back(rival.explanation->fitted.hypothesis.model);
    }
    d->effects.push_back(std::move(found));
  }
  for (size_t i = 0; i < free.size(); ++i) {
    if (free[i].unknown.kind == model::Unknown::Kind::kBase) {
      d->parameters.push_back(DescribeParameter(free[i], intervals[i], context.given));
    }
  }
  return rivals;
}

// Whether what was found takes a material part of the gap on every horizon but at most one, measured on runs
// that were not fitted: half of the squared gap that the model's own parameters leave.
bool TakesMaterialPart(const std::vector<HorizonGap>& horizons) {
  constexpr double kPart = 0.5;
  size_t material = 0;
  for (const HorizonGap& horizon : horizons) {
    const double before = std::pow(std::min(horizon.held_out.before, horizon.held_out.refit_only), 2) - 1;
    const double after = std::pow(horizon.held_out.after, 2) - 1;
    material += before > 0 && after < (1 - kPart) * before ? 1 : 0;
  }
  return !horizons.empty() && material + 1 >= horizons.size();
}

// The verdict on what was found: `d` has its effects, parameters and horizons.
Verdict VerdictOn(const SearchContext& context, const SearchResult& search, const Diagnosis& d) {
  const Explanation& best = search.best;
  const bool exact = ExactSensors(context.runs);
  if (!Closed(search.given.held_out_gap(), best.held_out_gap(), exact) ||
      !Closed(search.given.squared_gap(), best.squared_gap(), exact)) {
    const double refitted = std::min(d.held_out.before, d.held_out.refit_only);
    const bool found = !d.effects.empty() && TakesMaterialPart(d.horizons) &&
                       Material(refitted * refitted, best.held_out_gap());
    return found ? Verdict::kPartly : Verdict::kUnexplained;
  }
  if (best.changes().empty() && d.parameters.empty()) return Verdict::kNothingMissing;
  if (d.effects.empty()) return Verdict::kParameters;
  const bool tied = std::any_of(d.effects.begin(), d.effects.end(),
                                [](const FoundEffect& effect) { return !effect.tied_with.empty(); });
  return tied ? Verdict::kTied : Verdict::kNamed;
}

void NameRuns(const SearchContext& context, Diagnosis* d) {
  for (const RunData* run : context.runs) {
    d->runs.push_back(run->name);
    d->samples += run->samples();
  }
  for (const RunData* run : context.held_out) d->held_out_runs.push_back(run->name);
}

}  // namespace

Diagnosis Conclude(const SearchContext& context, const SearchResult& search, const Explanation& refit,
                   const WindowTrials& windows) {
  const ProgressCallback& report_progress = context.report_progress;
  const Explanation& given = search.given;
  const Explanation& best = search.best;
  Diagnosis d;
  d.fit = FitGaps(given, refit, best);
  d.held_out = HeldOutGaps(given, refit, best);
  if (report_progress) report_progress({"intervals", 0.95});
  const std::vector<model::ModelDescription> rivals = DescribeFound(context, search, &d);
  d.horizons = HorizonGaps(context, SearchHorizon(context.runs), given, refit, best);
  d.verdict = VerdictOn(context, search, d);
  d.model = best.fitted.hypothesis.model;
  d.signals = SignalGaps(context, given, refit, best);
  d.candidates = Ranking(context, search, WeightsOf(context, search, refit, windows), windows);
  d.curves = CurvesOf(context, given, best);
  if (d.verdict != Verdict::kNothingMissing) {
    if (report_progress) report_progress({"where the gap is", 0.97});
    Localisation located = Locate(IsOpen(d.verdict) ? d.model : context.given, context.runs);
    d.location = std::move(located.location);
    d.missing = std::move(located.missing);
  }
  if (d.verdict == Verdict::kTied) {
    if (report_progress) report_progress({"the next experiment", 0.98});
    d.next = DesignNextExperiment(rivals, context.runs, WhyNext(d.effects));
  }
  NameRuns(context, &d);
  d.sentence = Sentence(d);
  return d;
}

}  // namespace hydro::diagnose
