#include "diagnose/search/explanation.h"

#include <algorithm>

#include "diagnose/fit/start_fit.h"

namespace hydro::diagnose {

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

Explanation Explain(const SearchContext& context, const Hypothesis& hypothesis,
                    const std::vector<model::StartState>& starts, const FitOptions& options) {
  Explanation explanation;
  explanation.fitted = Fit(hypothesis, context.runs, starts, options);
  if (!explanation.fitted.ok()) return explanation;
  explanation.windows = context.windows;
  explanation.held_out = context.held_out.empty()
                             ? PredictInTurn(explanation.fitted, context.given, context.runs, options.jobs)
                             : Predict(explanation.fitted, context.held_out, options.jobs);
  explanation.blocks = context.windows ? LogarithmsOf(explanation.held_out)
                                       : BlocksOf(context.predicted(), explanation.held_out);
  return explanation;
}

Explanation RefitFromOtherStarts(const SearchContext& context, const Explanation& one,
                                 const FitOptions& options) {
  if (one.fitted.squared_gap() <= kStartInDoubt) return one;
  Explanation best = one;
  const auto begin_at = [&](const std::vector<model::StartState>& starts) {
    if (TimeIsUp(context)) return;
    Explanation again = Explain(context, one.fitted.hypothesis, starts, options);
    if (again.fitted.ok() && again.fitted.sum < best.fitted.sum) best = std::move(again);
  };
  begin_at(MeasuredStarts(context.runs));
  // A window is too short to be caught in another place.
  if (context.windows || best.fitted.squared_gap() <= kStartInDoubt) return best;
  begin_at(BestStarts(best.fitted.hypothesis, context.runs, StartsOf(best.fitted), options.jobs));
  return best;
}

}  // namespace hydro::diagnose
