#include "diagnose/search/wide_search.h"

#include <utility>

#include "diagnose/fit/identifiable.h"

namespace hydro::diagnose {

namespace {

// The squared gap above which a model is wrong everywhere.
constexpr double kWrongEverywhere = 25;

// The given model with all base parameters fitted that the runs identify; the model as given where that
// fails.
Explanation Refit(const SearchContext& context, const Hypothesis& as_given, const Explanation& given,
                  const std::vector<size_t>& allowed) {
  const std::vector<model::StartState> starts = StartsOf(given.fitted);
  Hypothesis refitted = as_given;
  for (const model::EffectDescription& effect : context.given.effects) refitted.effects.push_back(effect.id);
  refitted.base = Identifiable(as_given, context.runs, starts, allowed, context.sizes, context.jobs);
  FitOptions fine;
  fine.tolerance = 1e-5;
  fine.jobs = context.jobs;
  Explanation refit = Explain(context, refitted, starts, fine);
  return refit.fitted.ok() ? refit : given;
}

// Searches again from the refitted model if that predicts better, and keeps the result if it beats that of
// `search`.
void SearchFromRefit(const SearchContext& context, const Explanation& refit, SearchResult* search) {
  // A few changes do not close so large a gap: search for the rest once the parameters fit.
  const double gap = search->best.held_out_gap();
  const bool far = gap > kWrongEverywhere && refit.held_out_gap() < gap;
  if (!far && !Material(gap, refit.held_out_gap())) return;
  SearchResult wider = Search(context, refit.fitted.hypothesis, kMostChanges);
  if (!wider.given.fitted.ok() || !Material(gap, wider.best.held_out_gap())) return;
  search->best = std::move(wider.best);
  search->tried.insert(search->tried.end(), wider.tried.begin(), wider.tried.end());
}

}  // namespace

WideSearch SearchWidely(const SearchContext& context, const Hypothesis& as_given,
                        const std::vector<size_t>& allowed) {
  WideSearch wide;
  // Try few changes to the model as given first: one wrong value or one missing effect is the likeliest.
  wide.search = Search(context, as_given, kMostChanges);
  if (!wide.search.given.fitted.ok()) return wide;
  if (context.report_progress) context.report_progress({"refitting the model's own parameters", 0.92});
  wide.refit = Refit(context, as_given, wide.search.given, allowed);
  if (!TimeIsUp(context)) SearchFromRefit(context, wide.refit, &wide.search);
  return wide;
}

}  // namespace hydro::diagnose
