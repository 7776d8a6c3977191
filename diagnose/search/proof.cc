#include "diagnose/search/proof.h"

#include <utility>

#include "diagnose/search/window_search.h"

namespace hydro::diagnose {

namespace {

// How many explanations that lead on windows are tried on whole runs.
constexpr size_t kMostProved = 5;

// Fits the hypothesis to the whole runs; from other starts too where it leaves a small gap, which another start
// may close.
Explanation Prove(const SearchContext& context, const Hypothesis& hypothesis) {
  constexpr double kSmall = 4;
  const Explanation one = Explain(context, hypothesis, MeasuredStarts(context.runs), FineFit(context.jobs));
  const bool small = one.fitted.ok() && one.squared_gap() < kSmall;
  return small && !TimeIsUp(context) ? RefitFromOtherStarts(context, one, FineFit(context.jobs)) : one;
}

WindowTrials TrialsOn(const SearchWindows& windows, const WideSearch& near) {
  WindowTrials trials{near.search.tried, {}};
  for (const Explanation* one : {&near.search.given, &near.search.best, &near.refit})
    trials.tried.push_back(*one);
  for (const RunData* window : windows.choosing) trials.runs.push_back(window->name);
  return trials;
}

// Continues from the best explanation on the whole runs.
void SearchOn(const SearchContext& context, SearchResult* proved) {
  const int changes = static_cast<int>(proved->best.changes().size());
  if (changes >= kMostChanges) return;
  SearchResult more = Search(context, proved->best.fitted.hypothesis, kMostChanges - changes);
  if (!more.given.fitted.ok()) return;
  if (Material(proved->best.held_out_gap(), more.best.held_out_gap())) proved->best = std::move(more.best);
  proved->tried.insert(proved->tried.end(), more.tried.begin(), more.tried.end());
}

}  // namespace

WideSearch SearchAndProve(const SearchContext& context, const Hypothesis& as_given,
                          const std::vector<size_t>& allowed) {
  const SearchWindows windows = WindowsForSearch(context.runs, context.given.parameters);
  const WideSearch near =
      windows.choosing.empty() ? WideSearch{} : SearchWidely(OnWindows(context, windows), as_given, allowed);
  if (windows.choosing.empty() || !near.search.given.fitted.ok()) {
    return SearchWidely(context, as_given, allowed);
  }
  WideSearch proved;
  if (context.report_progress) context.report_progress({"predicting the held-out runs", 0.93});
  proved.search.given = Explain(context, as_given, MeasuredStarts(context.runs), FineFit(context.jobs));
  if (!proved.search.given.fitted.ok()) return proved;
  proved.windows = TrialsOn(windows, near);
  proved.search.rated = near.search.rated;
  proved.search.best = proved.search.given;
  proved.refit =
      Explain(context, near.refit.fitted.hypothesis, MeasuredStarts(context.runs), FineFit(context.jobs));
  if (!proved.refit.fitted.ok()) proved.refit = proved.search.given;
  for (const Explanation* one : Leading(near.search, kMostProved)) {
    if (TimeIsUp(context) && !proved.search.tried.empty()) break;
    Explanation whole = Prove(context, one->fitted.hypothesis);
    if (!whole.fitted.ok()) continue;
    if (Material(proved.search.best.held_out_gap(), whole.held_out_gap())) proved.search.best = whole;
    proved.search.tried.push_back(std::move(whole));
  }
  const bool open = proved.search.best.held_out_gap() >= kCloseEnough;
  if (open && near.search.best.held_out_gap() < kOutOfReach && !TimeIsUp(context)) {
    SearchOn(context, &proved.search);
  }
  return proved;
}

}  // namespace hydro::diagnose
