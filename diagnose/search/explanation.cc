#include "diagnose/search/explanation.h"

#include <algorithm>
#include <utility>

#include "diagnose/fit/residuals.h"
#include "diagnose/fit/start_fit.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

namespace {

// Of windows: their starts are free, and say no more.
constexpr double kToSettleWindows = 1e-4;

// Stretches of a signal, in a search horizon, that count as independent of each other.
constexpr double kIndependent = 10;

// How many independent pieces of evidence the runs hold, if they are as wrong as a wrong model leaves them.
double EvidenceOf(const std::vector<const RunData*>& runs) {
  double pieces = 0;
  for (const RunData* run : runs) {
    const double stretches = std::max(1.0, run->duration() / kHorizon);
    pieces += kIndependent * stretches * static_cast<double>(run->signals.size());
  }
  return pieces;
}

bool Gains(double sum, double before) { return sum < (1 - kToCompare) * before; }

// The explanation, or as fitted from these values and starts if that is better.
Explanation RefitFrom(const SearchContext& context, const Explanation& one, const Hypothesis& values,
                      const std::vector<model::StartState>& starts, const FitOptions& options) {
  Fitted again = Fit(values, context.runs, starts, options);
  const bool better = again.ok() && Gains(again.sum, one.fitted.sum);
  return better ? ExplanationOf(context, std::move(again), options.jobs) : one;
}

}  // namespace

double NumbersFactor(const Hypothesis& hypothesis) {
  double factor = 1;
  for (const FreeParameter& parameter : hypothesis.Free()) {
    factor += parameter.unknown.kind == model::Unknown::Kind::kBase ? 0.005 : 0.01;
  }
  return factor;
}

double Cost(double squared_gap, double numbers_factor) {
  return std::max(1.0, squared_gap) * numbers_factor + std::min(0.0, squared_gap - 1);
}

bool LeavesNothing(const SearchContext& context, const Explanation& one, double squared_gap) {
  if (one.held_out_gap() < squared_gap) return true;
  return context.held_out.empty() && !one.changes().empty() && one.squared_gap() < squared_gap;
}

bool TimeIsUp(const SearchContext& context) { return context.time_is_up && context.time_is_up(); }

FitOptions FineFit(int jobs) {
  FitOptions fine;
  fine.most_iterations = 15;
  fine.tolerance = 1e-5;
  fine.jobs = jobs;
  return fine;
}

FitOptions FitToCompare(int jobs) {
  FitOptions compare = FineFit(jobs);
  compare.tolerance = kToCompare;
  return compare;
}

Explanation ExplanationOf(const SearchContext& context, Fitted fitted, int jobs) {
  Explanation explanation;
  explanation.fitted = std::move(fitted);
  if (!explanation.fitted.ok()) return explanation;
  explanation.windows = context.windows;
  explanation.held_out = context.held_out.empty()
                             ? PredictInTurn(explanation.fitted, context.given, context.runs, jobs)
                             : Predict(explanation.fitted, context.held_out, jobs);
  explanation.blocks = context.windows ? LogarithmsOf(explanation.held_out)
                                       : BlocksOf(context.predicted(), explanation.held_out);
  return explanation;
}

Explanation Explain(const SearchContext& context, const Hypothesis& hypothesis,
                    const std::vector<model::StartState>& starts, const FitOptions& options) {
  return ExplanationOf(context, Fit(hypothesis, context.runs, starts, options), options.jobs);
}

std::shared_ptr<const Knowledge> KnownAt(const SearchContext& context, double sum) {
  return std::make_shared<Knowledge>(Knowledge{context.given, sum / EvidenceOf(context.runs)});
}

void Settle(const SearchContext& context, Explanation* one) {
  FitOptions options = FineFit(context.jobs);
  if (context.windows) options.tolerance = kToSettleWindows;
  Explanation settled = Explain(context, one->fitted.hypothesis, StartsOf(one->fitted), options);
  if (settled.fitted.ok()) *one = std::move(settled);
}

Explanation RefitFromOtherStarts(const SearchContext& context, const Explanation& one,
                                 const FitOptions& options) {
  // A window is too short to be caught in another place.
  if (context.windows || one.fitted.squared_gap() <= kStartInDoubt || TimeIsUp(context)) return one;
  const std::vector<model::StartState> measured = MeasuredStarts(context.runs);
  return RefitFromBestStarts(context, RefitFrom(context, one, one.fitted.hypothesis, measured, options),
                             options);
}

Explanation RefitFromGivenValues(const SearchContext& context, const Explanation& one,
                                 const FitOptions& options) {
  constexpr int kRounds = 3;
  Explanation best = one;
  if (!context.windows || one.fitted.hypothesis.known == nullptr || one.changes().empty()) return one;
  for (int round = 0; round < kRounds && !TimeIsUp(context); ++round) {
    const double before = best.fitted.sum;
    Hypothesis values = best.fitted.hypothesis;
    for (const size_t place : values.base) {
      const auto member = model::BaseParameters()[place].member;
      values.model.parameters.*member = context.given.parameters.*member;
    }
    values.known = KnownAt(context, before);
    best = RefitFrom(context, best, values, MeasuredStarts(context.runs), options);
    if (best.fitted.sum > 0.5 * before) break;  // what is known counts about as it should
  }
  return best;
}

Explanation RefitFromBestStarts(const SearchContext& context, const Explanation& one,
                                const FitOptions& options) {
  if (one.fitted.squared_gap() <= kStartInDoubt || TimeIsUp(context)) return one;
  const Hypothesis& hypothesis = one.fitted.hypothesis;
  const std::vector<model::StartState> starts =
      BestStarts(hypothesis, context.runs, StartsOf(one.fitted), options.jobs);
  double sum = 0;
  for (size_t r = 0; r < starts.size(); ++r)
    sum += SumOfSquares(hypothesis.model, *context.runs[r], starts[r]);
  return Gains(sum, one.fitted.sum) ? RefitFrom(context, one, hypothesis, starts, options) : one;
}

}  // namespace hydro::diagnose
