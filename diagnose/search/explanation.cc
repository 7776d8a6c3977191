#include "diagnose/search/explanation.h"

#include <algorithm>
#include <utility>

#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

namespace {

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

bool SameChanges(const Hypothesis& a, const Hypothesis& b) {
  if (a.changes.size() != b.changes.size()) return false;
  return std::all_of(a.changes.begin(), a.changes.end(), [&](const Change& change) { return b.Has(change); });
}

}  // namespace hydro::diagnose
