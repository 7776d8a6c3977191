#include "diagnose/verdict/conclusion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "base/number_text.h"
#include "diagnose/closure/closure.h"
#include "diagnose/say/effect_term.h"
#include "diagnose/say/locate.h"
#include "diagnose/say/measured_curves.h"
#include "diagnose/say/worst_signal.h"
#include "diagnose/search/window_search.h"
#include "diagnose/verdict/choice_without.h"
#include "diagnose/verdict/effect_stretch.h"
#include "diagnose/verdict/evidence.h"
#include "diagnose/verdict/found.h"
#include "diagnose/verdict/horizons.h"
#include "diagnose/verdict/mains_hum.h"
#include "diagnose/verdict/next_experiment.h"
#include "diagnose/verdict/ranking.h"
#include "diagnose/verdict/run_curves.h"
#include "diagnose/verdict/sentence.h"
#include "diagnose/verdict/shown_noise.h"
#include "model/effects/catalogue.h"

namespace hydro::diagnose {

namespace {

BeforeAfter FitGaps(const Explanation& given, const Explanation& refit, const Explanation& best) {
  return {std::sqrt(given.squared_gap()), std::sqrt(refit.squared_gap()), std::sqrt(best.squared_gap())};
}

BeforeAfter HeldOutGaps(const Explanation& given, const Explanation& refit, const Explanation& best) {
  return {std::sqrt(given.held_out_gap()), std::sqrt(refit.held_out_gap()), std::sqrt(best.held_out_gap())};
}

// The gap that what was found has to beat: effects that of the model's own values too, values only that of the
// model as given.
double GapToCompare(const Diagnosis& d, const BeforeAfter& gap) {
  return d.effects.empty() ? gap.before : std::min(gap.before, gap.refit_only);
}

// Whether what was found takes a material part of the gap on every horizon but at most one, measured on runs
// that were not fitted: half of the squared gap of the typical window. Whole runs are one horizon among the
// others.
bool TakesMaterialPart(const Diagnosis& d) {
  constexpr double kPart = 0.5;
  const auto takes = [&](const BeforeAfter& gap) {
    const double before = std::pow(GapToCompare(d, gap), 2) - 1;
    return before > 0 && std::pow(gap.after, 2) - 1 < (1 - kPart) * before;
  };
  size_t material = takes(d.held_out) ? 1 : 0, simulated = 0;
  for (const HorizonGap& horizon : d.horizons) {
    material += takes(horizon.typical) ? 1 : 0;
    simulated += std::isfinite(horizon.typical.after) ? 1 : 0;
  }
  return material >= std::max<size_t>(simulated, 1);
}

// The verdict on what was found: `d` has its effects, parameters and horizons.
Verdict VerdictOn(const SearchContext& context, const Kept& kept, const Diagnosis& d) {
  const Explanation& given = kept.search.given;
  const Explanation& best = kept.search.best;
  const bool exact = ExactSensors(context.runs);
  if (!kept.doubts.empty() || !Closed(given.held_out_gap(), best.held_out_gap(), exact) ||
      !Closed(given.squared_gap(), best.squared_gap(), exact)) {
    const bool something = !d.effects.empty() || !d.parameters.empty();
    const bool found = something && TakesMaterialPart(d);
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

// Says of values that were found which effects do as well.
void RemarkOnRivals(const std::map<std::string, double>& weights, Diagnosis* d) {
  constexpr double kWorthAWord = 0.2;
  for (const auto& [claim, weight] : weights) {
    // Values of an effect that the model has are values too.
    const bool rival = claim.find('.') != std::string::npos && !claim.starts_with("parameters of ");
    if (d->verdict != Verdict::kParameters || !rival || weight < kWorthAWord) continue;
    d->remarks.push_back(claim + " explains the runs about as well as other values (weight " +
                         ShortNumber(weight, 2) + ")");
  }
}

// Says of the user's own effects (--effect) which were never refitted, so that nobody takes them to be ruled out.
void RemarkOnUsersOwn(Diagnosis* d) {
  for (const Candidate& candidate : d->candidates) {
    const std::string id = candidate.id.substr(0, candidate.id.find(' '));
    const bool tried = std::isfinite(candidate.fit);
    if (tried || model::FindEffect(id) == nullptr || model::IsBuiltIn(id)) continue;
    d->remarks.push_back(candidate.id + " was not refitted (" + candidate.rejected_because +
                         "), so it is not ruled out: --effects with a list of it alone tries it first");
  }
}

// Whether what was found predicts held-out runs worse than the model as given does.
bool IsWorse(const BeforeAfter& held_out) {
  constexpr double kNoticeable = 1.01;
  return held_out.after > kNoticeable * held_out.before;
}

// Whether it does so on whole runs and on most horizons: then nothing was found.
bool IsWorseAlmostEverywhere(const Diagnosis& d) {
  size_t worse = 0, simulated = 0;
  for (const HorizonGap& horizon : d.horizons) {
    if (!std::isfinite(horizon.typical.after)) continue;
    ++simulated;
    worse += horizon.typical.after > horizon.typical.before ? 1 : 0;
  }
  return IsWorse(d.held_out) && 2 * worse >= simulated;
}

// Says where the held-out runs do not show what the fitted ones do.
void RemarkOnSilence(const Explanation& given, const Explanation& best, Diagnosis* d) {
  const bool something = !d->effects.empty() || !d->parameters.empty();
  if (IsOpen(d->verdict) || !something || Material(given.held_out_gap(), best.held_out_gap())) return;
  d->remarks.push_back(
      "The held-out runs do not show what was found: the model as given predicts them as well. The claim "
      "rests on the fitted runs alone; "
      "hold out a run that moves as they do");
}

}  // namespace

Diagnosis Conclude(const SearchContext& context, const SearchResult& search, const Explanation& refit,
                   const WindowTrials& windows) {
  const ProgressCallback& report_progress = context.report_progress;
  const std::map<std::string, double> weights = WeightsOf(context, search, refit, windows);
  if (report_progress) report_progress({"intervals", 0.95});
  Kept kept = KeepWhatIsThere(context, search, windows);
  const Explanation& given = search.given;
  const Explanation& best = kept.search.best;
  Diagnosis d;
  d.fit = FitGaps(given, refit, best);
  d.held_out = HeldOutGaps(given, refit, best);
  const std::vector<model::ModelDescription> rivals =
      DescribeFound(context, refit, windows, weights, &kept, &d);
  d.horizons = HorizonGaps(context, SearchHorizon(context.runs), given, refit, best);
  if (IsWorse(d.held_out)) kept.doubts.emplace_back("held-out runs are predicted worse with it than without");
  d.verdict = VerdictOn(context, kept, d);
  const bool changed = !best.changes().empty() || !best.fitted.hypothesis.Free().empty();
  if (d.verdict == Verdict::kUnexplained && changed && IsWorseAlmostEverywhere(d)) {
    SearchResult nothing = search;
    nothing.best = search.given;
    return Conclude(context, nothing, refit, windows);
  }
  RemarkOnSilence(given, best, &d);
  const std::vector<std::string> hum = HumRemarks(context.runs, best.fitted);
  d.remarks.insert(d.remarks.begin(), hum.begin(), hum.end());
  RemarkOnRivals(weights, &d);
  d.model = best.fitted.hypothesis.model;
  d.signals = SignalGaps(context, given, refit, best);
  d.candidates = Ranking(context, kept.search, weights, windows);
  RemarkOnUsersOwn(&d);
  d.curves = CurvesOf(context, given, best);
  ClosedModel closed;
  if (d.verdict != Verdict::kNothingMissing) {
    if (report_progress) report_progress({"where the gap is", 0.97});
    const ClosureBase base =
        IsOpen(d.verdict) ? BaseOfClosure(context, best, refit, windows) : ClosureBase{&given};
    Localisation located = Locate(base.explanation->fitted.hypothesis.model, context.runs, context.jobs);
    d.location = std::move(located.location);
    if (d.location.empty()) d.location = WorstSignal(d.signals, d.curves, IsOpen(d.verdict));
    d.missing = std::move(located.missing);
  }
  d.measured = MeasuredCurves(given.fitted.hypothesis.model, d.model, context.runs, context.jobs);
  for (const FoundEffect& effect : d.effects) {
    if (std::optional<FoundTerm> term = TermOf(d.model, effect.id, context.runs, context.jobs)) {
      d.terms.push_back(std::move(*term));
    } else if (std::optional<FoundStretch> stretch = StretchOf(context, best, effect.id)) {
      d.stretches.push_back(std::move(*stretch));
    }
  }
  AddClosures(std::move(closed), &d);
  if (rivals.size() > 1 && !TimeIsUp(context)) {
    if (report_progress) report_progress({"the next experiment", 0.98});
    d.next = DesignNextExperiment(rivals, context.runs, WhyNext(d.effects));
  }
  NameRuns(context, &d);
  if (context.held_out.empty()) {
    d.choices = ChoicesWithoutEach(DecidingContest(context, kept.search, refit, windows),
                                   ClaimOf(best.fitted.hypothesis));
  }
  d.sentence =
      Sentence(d, kept.doubts) + ClosureSentence(d.closures) +
      (IsOpen(d.verdict) ? ShownNoiseSentence(d.verdict, GapInShownNoise(context.predicted(), best.held_out))
                         : "");
  return d;
}

}  // namespace hydro::diagnose
