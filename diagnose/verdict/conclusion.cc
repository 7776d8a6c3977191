#include "diagnose/verdict/conclusion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "base/number_text.h"
#include "diagnose/closure/closure.h"
#include "diagnose/say/locate.h"
#include "diagnose/say/measured_curves.h"
#include "diagnose/verdict/choice_without.h"
#include "diagnose/verdict/effect_stretch.h"
#include "diagnose/verdict/evidence.h"
#include "diagnose/verdict/found.h"
#include "diagnose/verdict/horizons.h"
#include "diagnose/verdict/judgement.h"
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

// Says where the held-out runs do not show what the fitted ones do. Windows that decide are held out: they do.
void RemarkOnSilence(const Explanation& given, const Explanation& best, Diagnosis* d) {
  const bool something = !d->effects.empty() || !d->parameters.empty();
  const bool comparable = std::isfinite(given.held_out_gap()) && std::isfinite(best.held_out_gap());
  if (IsOpen(d->verdict) || !something || !comparable) return;
  if (Material(given.held_out_gap(), best.held_out_gap())) return;
  d->remarks.push_back(
      "The held-out runs do not show what was found: the model as given predicts them as well. The claim "
      "rests on the fitted runs alone; "
      "hold out a run that moves as they do");
}

// Says where windows and whole runs disagree.
void RemarkOnWholeRuns(const Diagnosis& so_far, std::vector<std::string>* remarks) {
  const BeforeAfter& gap = so_far.held_out;
  if (!std::isfinite(gap.after)) {
    remarks->push_back(
        std::isfinite(gap.before)
            ? "Over whole runs the model with what was found cannot be simulated; it is judged "
              "by windows of them"
            : "Over whole runs no model can be simulated; windows of them are compared");
  } else if (!std::isfinite(gap.before)) {
    remarks->push_back(
        "Over whole runs the model as given cannot be simulated; it is judged by windows of them");
  } else if (IsWorse(gap)) {
    remarks->push_back("Over whole held-out runs, where every small error adds up, the gap is " +
                       ShortNumber(gap.after, 3) + " noise units with what was found and " +
                       ShortNumber(gap.before, 3) + " with the model as given");
  }
}

// Whether a gap is left although something was found that simulation alone speaks for: balances that see all of the fitted runs give
// none of the effects, nor what they are tied with, a twentieth. What balances cannot see (an arm that gives, a valve that regulates) is
// simulation's to say.
bool HasOneWitness(const Diagnosis& d) {
  constexpr double kAWord = 0.05;
  if (d.effects.empty() || d.explanations.empty()) return false;
  const auto said = [&](const std::string& id) {
    double weight = 0;
    for (const WeightedSet& one : d.explanations) {
      const bool has = std::any_of(one.changes.begin(), one.changes.end(), [&](const std::string& change) {
        return change.substr(0, change.find('(')) == id;
      });
      weight += has ? one.weight : 0;
    }
    return weight >= kAWord;
  };
  return std::none_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& effect) {
    const bool blind =
        effect.id == "arm.flexure" || effect.id == "valve.relief" || effect.id == "sensor.sign";
    return blind || said(effect.id) || std::any_of(effect.tied_with.begin(), effect.tied_with.end(), said);
  });
}

// Where each effect that was found acts, or shows.
void ShowEffects(const SearchContext& context, const Explanation& best, Diagnosis* d) {
  for (const FoundEffect& effect : d->effects) {
    if (std::optional<MeasuredCurve> term = TermOf(d->model, effect.id, context.runs, context.jobs)) {
      d->terms.push_back(std::move(*term));
    } else if (std::optional<FoundStretch> stretch = StretchOf(context, best, effect.id)) {
      d->stretches.push_back(std::move(*stretch));
    }
  }
}

WideSearch NothingFound(const WideSearch& found) {
  WideSearch nothing = found;
  nothing.search.best = found.search.given;
  return nothing;
}

bool IsChanged(const Explanation& best) {
  return !best.changes().empty() || !best.fitted.hypothesis.Free().empty();
}

std::string SentenceOf(const SearchContext& context, const WideSearch& found, const Kept& kept,
                       const Diagnosis& d) {
  std::string sentence =
      Sentence(d, kept.doubts, GapToCompare(d, found.windows)) + ClosureSentence(d.closures);
  if (!IsOpen(d.verdict)) return sentence;
  return sentence +
         ShownNoiseSentence(d.verdict, GapInShownNoise(context.predicted(), kept.search.best.held_out));
}

}  // namespace

Diagnosis Conclude(const SearchContext& context, const WideSearch& found,
                   const std::vector<WeightedSet>& explanations) {
  const ProgressCallback& report_progress = context.report_progress;
  const WindowTrials& windows = found.windows;
  const std::map<std::string, double> weights = WeightsOf(context, found, explanations);
  if (report_progress) report_progress({"intervals", 0.95});
  Kept kept = KeepWhatIsThere(context, found.search, windows);
  const Explanation& given = found.search.given;
  const Explanation& best = kept.search.best;
  Diagnosis d;
  d.explanations = explanations;
  d.fit = FitGaps(given, found.refit, best);
  d.held_out = HeldOutGaps(given, found.refit, best);
  const std::vector<model::ModelDescription> rivals =
      DescribeFound(context, found.refit, windows, weights, &kept, &d);
  d.horizons = HorizonGaps(context, given, found.refit, best);
  if (!windows.decide && IsWorse(d.held_out))
    kept.doubts.emplace_back("held-out runs are predicted worse with it than without");
  d.verdict = VerdictOn(context, kept, windows, d);
  if (d.verdict == Verdict::kPartly && HasOneWitness(d)) d.verdict = Verdict::kUnexplained;
  const bool nothing = d.verdict == Verdict::kNothingMissing ||
                       (d.verdict == Verdict::kUnexplained && IsWorseAlmostEverywhere(d));
  if (nothing && IsChanged(best)) return Conclude(context, NothingFound(found), explanations);
  if (windows.decide) {
    RemarkOnWholeRuns(d, &d.remarks);
  } else {
    RemarkOnSilence(given, best, &d);
  }
  const std::vector<std::string> hum = HumRemarks(context.runs, best.fitted);
  d.remarks.insert(d.remarks.begin(), hum.begin(), hum.end());
  RemarkOnRivals(weights, &d);
  d.model = best.fitted.hypothesis.model;
  d.signals = SignalGaps(context, given, found.refit, best);
  d.candidates = Ranking(context, kept.search, weights, windows);
  RemarkOnUsersOwn(&d);
  d.curves = CurvesOf(context, given, best);
  if (d.verdict != Verdict::kNothingMissing) {
    if (report_progress) report_progress({"where the gap is", 0.97});
    Localisation located =
        Locate(IsOpen(d.verdict) ? d.model : given.fitted.hypothesis.model, context.runs, context.jobs);
    d.location = std::move(located.location);
    if (d.location.empty()) d.location = WorstSignal(d.signals, d.curves, IsOpen(d.verdict));
    d.missing = std::move(located.missing);
  }
  d.measured = MeasuredCurves(given.fitted.hypothesis.model, d.model, context.runs, context.jobs);
  ShowEffects(context, best, &d);
  if (rivals.size() > 1 && !TimeIsUp(context)) {
    if (report_progress) report_progress({"the next experiment", 0.98});
    d.next = DesignNextExperiment(rivals, context.runs, WhyNext(d.effects));
  }
  NameRuns(context, &d);
  if (context.held_out.empty()) {
    d.choices = ChoicesWithoutEach(DecidingContest(context, kept.search, found.refit, windows),
                                   ClaimOf(best.fitted.hypothesis));
  }
  d.sentence = SentenceOf(context, found, kept, d);
  return d;
}

}  // namespace hydro::diagnose
