#include "diagnose/say/conclusion.h"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "diagnose/fit/closure.h"
#include "diagnose/recording/noise_remarks.h"
#include "diagnose/say/candidates.h"
#include "diagnose/say/common_factor.h"
#include "diagnose/say/error_growth.h"
#include "diagnose/say/found.h"
#include "diagnose/say/gaps.h"
#include "diagnose/say/judgement.h"
#include "diagnose/say/locate.h"
#include "diagnose/say/measured_curves.h"
#include "diagnose/say/next_experiment.h"
#include "diagnose/say/run_curves.h"
#include "diagnose/say/sentence.h"
#include "diagnose/say/two_witnesses.h"
#include "model/effects/catalogue.h"

namespace hydro::diagnose {
namespace {

void NameRuns(const ProofContext& context, Diagnosis* d) {
  for (const RunData* run : context.runs) {
    d->runs.push_back(run->name);
    d->samples += run->samples();
  }
  for (const RunData* run : context.held_out) d->held_out_runs.push_back(run->name);
}

// Says which of the user's own effects (--effect) were never simulated, so that nobody takes them to be ruled
// out.
void RemarkOnUsersOwn(Diagnosis* d) {
  for (const Candidate& candidate : d->candidates) {
    const std::string id = candidate.id.substr(0, candidate.id.find(' '));
    const bool tried = std::isfinite(candidate.held_out);
    if (tried || model::FindEffect(id) == nullptr || model::IsBuiltIn(id)) continue;
    d->remarks.push_back(candidate.id + " was not refitted (" + candidate.rejected_because +
                         "), so it is not ruled out: --effects with a list of it alone tries it first");
  }
}

// Says where windows and whole runs disagree.
void RemarkOnWholeRuns(const BeforeAfter& gap, const BeforeAfter& of_fitted,
                       std::vector<std::string>* remarks) {
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
  } else if (IsWorse(of_fitted)) {
    remarks->push_back("Over whole fitted runs, where every small error adds up, the gap is " +
                       ShortNumber(of_fitted.after, 3) + " noise units with what was found and " +
                       ShortNumber(of_fitted.before, 3) + " with the model as given");
  }
}

// Says where only the held-out runs differ from the model: then nothing that was fitted can close the gap.
void RemarkOnOtherMachine(const BeforeAfter& held_out, const BeforeAfter& fitted,
                          std::vector<std::string>* remarks) {
  const double noise = fitted.before * fitted.before, apart = held_out.before * held_out.before;
  if (!(noise <= kCloseEnough && apart > kNoiseAndAsMuchAgain * kCloseEnough)) return;
  remarks->push_back("The model as given predicts the fitted runs to the noise (" +
                     ShortNumber(fitted.before, 3) + ") and the held-out runs not (" +
                     ShortNumber(held_out.before, 3) + "): these may be of another machine, load or setting");
}

// Shows where each effect that was found acts, or where it is visible.
void ShowEffects(const ProofContext& context, const Proof& proof, const WholeRuns& whole, Diagnosis* d) {
  for (const FoundEffect& effect : d->effects) {
    if (std::optional<MeasuredCurve> term = TermOf(d->model, effect.id, context.runs, context.jobs)) {
      d->terms.push_back(std::move(*term));
    } else if (std::optional<FoundStretch> stretch = StretchOf(context, proof, whole, effect.id)) {
      d->stretches.push_back(std::move(*stretch));
    }
  }
}

void ShowWhere(const ProofContext& context, Diagnosis* d) {
  const bool open = IsOpen(d->verdict);
  Localisation located = Locate(open ? d->model : context.given, context.runs, context.jobs);
  d->location = std::move(located.location);
  if (d->location.empty()) d->location = WorstSignal(d->signals, d->curves, open);
  d->missing = std::move(located.missing);
}

// A motion that multiplies errors by more than this is unstable at times: friction only makes them less.
constexpr double kMultiplies = 10;

// The growth of errors in the model as given, over all runs.
double GrowthOver(const ProofContext& context) {
  std::vector<const RunData*> all = context.runs;
  all.insert(all.end(), context.held_out.begin(), context.held_out.end());
  return ErrorGrowth(context.given, all, context.jobs);
}

}  // namespace

Diagnosis Conclude(const ProofContext& context, const Proof& proof, const Proposed& proposed) {
  context.Report("intervals", 0.95);
  Diagnosis d;
  for (const WeighedExplanation& one : proposed.weights.explanations)
    d.explanations.push_back({one.changes, one.weight});
  d.set_90 = proposed.weights.in_90;
  d.model = proof.Found().model;
  d.by_run = proof.Best().by_run;
  d.half_fitted = context.held_out.empty() && proof.Best().without.empty() && !proof.Found().Free().empty();
  const std::vector<model::ModelDescription> tied = DescribeFound(context, proof, &d);
  const WholeRuns whole = OverWholeRuns(context, proof);
  DescribeGaps(context, whole, &d);
  d.horizons = HorizonGaps(context, proof);
  d.noise_shown = NoiseShown(context.runs);
  const double growth = proof.best == proof.given ? GrowthOver(context) : 1;
  const RunsJudged judged = JudgedBy(context.runs, growth);
  d.recorder_may_be = MayBeTheRecorders(d, proposed.scores, judged);
  d.verdict = VerdictOn(d, proof, proposed.scores, judged);
  const bool values_alone = d.effects.empty() && d.closures.empty() && proof.best != proof.given;
  const bool nothing_missing = d.verdict == Verdict::kNothingMissing;
  const BeforeAfter gap = GapToCompare(d, proof).gap;
  if (values_alone && (nothing_missing || (IsOpen(d.verdict) && !(gap.after < gap.before)))) {
    // Other values that are not clearly different, or that take nothing of the gap, stay as given.
    Proof nothing = proof;
    nothing.best = proof.given;
    nothing.given_suffices = nothing_missing && !proof.OnWindows();
    return Conclude(context, nothing, proposed);
  }
  HearBothWitnesses(proof, &d);
  RemarkOnOtherMachine(d.held_out, d.fit, &d.remarks);
  if (proof.OnWindows()) RemarkOnWholeRuns(d.held_out, d.fit, &d.remarks);
  if (d.verdict == Verdict::kNothingMissing && growth > kMultiplies)
    d.remarks.push_back("An error of a start grows " + ShortNumber(growth, 2) +
                        " times over a whole run, so windows judge, and whole runs show only what is larger");
  d.candidates = CandidatesOf(context, proof, d, proposed.scores);
  RemarkOnUsersOwn(&d);
  d.curves = CurvesOf(context, proof, whole);
  context.Report("where the gap is", 0.97);
  if (d.verdict != Verdict::kNothingMissing) ShowWhere(context, &d);
  d.measured = MeasuredCurves(context.given, d.model, context.runs, context.jobs);
  ShowEffects(context, proof, whole, &d);
  if (tied.size() > 1 && !TimeIsUp(context)) {
    context.Report("the next experiment", 0.98);
    d.next = DesignNextExperiment(tied, context.runs, WhyNext(d.effects));
  }
  NameRuns(context, &d);
  if (context.held_out.empty()) d.choices = ChoicesWithoutEach(proof);
  d.compared = GapToCompare(d, proof);
  d.sentence = Sentence(d, d.compared) + ClosureSentence(d.closures);
  const std::string common = RemarkOnCommonFactor(context, proof, d);
  if (!common.empty()) {
    d.remarks.insert(d.remarks.begin(), common);
    d.sentence += " " + common + ".";
  }
  return d;
}

}  // namespace hydro::diagnose
