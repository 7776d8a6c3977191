#include "diagnose/search/wide_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "diagnose/search/ringing.h"
#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

// More other values than these are a refit of all.
constexpr int kFewValues = 2;
// A single change to the model as given has to come, in the race, to so many times the sum of squares of the refit.
constexpr double kRivalTimes = 1.5;

// The given model with all base parameters fitted that the runs identify; the model as given where that
// fails.
Explanation Refit(const SearchContext& context, const Hypothesis& as_given, const Explanation& given,
                  const std::vector<size_t>& allowed) {
  // The weight of what is known follows the gap that the refit leaves, which is not known beforehand.
  const std::vector<model::StartState> starts = StartsOf(given.fitted);
  Hypothesis refitted = as_given;
  for (const model::EffectDescription& effect : context.given.effects) refitted.effects.push_back(effect.id);
  refitted.base = allowed;
  refitted.known = KnownAt(context, given.fitted.sum);
  const Fitted fitted = Fit(refitted, context.runs, starts, FineFit(context.jobs));
  if (!fitted.ok()) return given;
  refitted = fitted.hypothesis;
  refitted.known = KnownAt(context, fitted.sum);
  Explanation refit = Explain(context, refitted, StartsOf(fitted), FineFit(context.jobs));
  return refit.fitted.ok() ? refit : given;
}

// The best explanation's effects in the model as given, where the refit of its values is not needed for them.
Explanation WithValuesAsGiven(const SearchContext& context, const Hypothesis& as_given,
                              const Explanation& best) {
  Hypothesis sparse = as_given;
  sparse.effects = best.fitted.hypothesis.effects;
  sparse.changes = best.changes();
  sparse.model.effects = best.fitted.hypothesis.model.effects;
  std::erase_if(sparse.changes, [](const Change& change) { return change.effect.empty(); });
  return Explain(context, sparse, StartsOf(best.fitted), FitToCompare(context.jobs));
}

// How many base parameters the fit surely moves: by four standard deviations of residuals as large as the gap.
int SurelyOther(const model::ModelDescription& given, const Fitted& fitted) {
  constexpr double kSurely = 4;
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto p = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  for (const RunFit& run : fitted.runs)
    information += Eigen::Map<const Eigen::MatrixXd>(run.information.data(), p, p);
  const Prior known = KnownBefore(fitted.hypothesis);
  for (Eigen::Index i = 0; i < p; ++i) information(i, i) += known.weight[static_cast<size_t>(i)];
  const Eigen::MatrixXd covariance = maths::SolveSymmetric(information, Eigen::MatrixXd::Identity(p, p));
  int count = 0;
  for (Eigen::Index i = 0; i < p; ++i) {
    const FreeParameter& parameter = free[static_cast<size_t>(i)];
    if (parameter.unknown.kind != model::Unknown::Kind::kBase) continue;
    const double before = given.parameters.*model::BaseParameters()[parameter.unknown.index].member;
    if (parameter.logarithmic && !(before > 0)) continue;
    const double moved = parameter.ToFitted(parameter.value) - parameter.ToFitted(before);
    const double variance = std::max(1.0, fitted.squared_gap()) * std::max(0.0, covariance(i, i));
    count += moved * moved > kSurely * kSurely * variance ? 1 : 0;
  }
  return count;
}

// Takes the best explanation's effects with the values as given, or with one or two others, where that predicts as well as all values
// refitted.
void TryFewValues(const SearchContext& context, const Hypothesis& as_given, SearchResult* search) {
  if (search->best.fitted.hypothesis.known == nullptr) return;
  const Explanation sparse = WithValuesAsGiven(context, as_given, search->best);
  if (!sparse.fitted.ok()) return;
  SearchResult few;
  few.best = sparse;
  const bool worse = Material(sparse.held_out_gap(), search->best.held_out_gap());
  if (worse && SurelyOther(context.given, search->best.fitted) <= kFewValues && !TimeIsUp(context)) {
    SearchContext values = context;
    std::erase_if(values.changes, [](const Change& change) { return !change.effect.empty(); });
    few = Search(values, sparse, {kFewValues, false});
  }
  search->tried.push_back(sparse);
  search->tried.insert(search->tried.end(), few.tried.begin(), few.tried.end());
  if (!Material(few.best.held_out_gap(), search->best.held_out_gap())) search->best = few.best;
}

void SearchFrom(const SearchContext& context, const Explanation& from, SearchResult* search) {
  SearchResult more = Search(context, from);
  if (Material(search->best.held_out_gap(), more.best.held_out_gap())) search->best = std::move(more.best);
  search->tried.insert(search->tried.end(), more.tried.begin(), more.tried.end());
}

}  // namespace

WideSearch SearchWidely(const SearchContext& runs, const Hypothesis& as_given,
                        const std::vector<size_t>& allowed) {
  SearchContext context = runs;
  WideSearch wide;
  const auto closed = [&] { return wide.search.best.held_out_gap() < kCloseEnough; };
  const auto report_progress = [&](const char* stage, double fraction) {
    if (context.report_progress) context.report_progress({stage, fraction});
  };
  report_progress("the model as given", 0);
  wide.search.given = Explain(context, as_given, MeasuredStarts(context.runs), FineFit(context.jobs));
  if (!wide.search.given.fitted.ok()) return wide;
  report_progress("refitting the model's own parameters", 0.02);
  wide.refit = Refit(context, as_given, wide.search.given, allowed);
  if (context.windows) {
    context.ringing = RingingFrequencies(wide.refit.fitted, context.runs, context.jobs);
  }
  // One wrong value or one missing effect is the likeliest.
  const Explanation given = wide.search.given;
  // Where the refit comes near the noise, one that does too may take more than a race to get there.
  const bool rival = context.windows && wide.refit.held_out_gap() > kOutOfReach;
  wide.search = Search(context, given, {1, false, {rival ? &wide.refit.fitted : nullptr, kRivalTimes}});
  if (closed() || TimeIsUp(context)) return wide;
  // No machine has exactly the values that its model has.
  wide.search.tried.push_back(wide.refit);
  if (Material(wide.search.best.held_out_gap(), wide.refit.held_out_gap())) wide.search.best = wide.refit;
  SearchFrom(context, wide.refit, &wide.search);
  TryFewValues(context, as_given, &wide.search);
  // Several wrong values or missing effects beside values that are right.
  const bool found = !wide.search.best.changes().empty();
  if (!closed() && !found && !TimeIsUp(context)) SearchFrom(context, given, &wide.search);
  return wide;
}

}  // namespace hydro::diagnose
