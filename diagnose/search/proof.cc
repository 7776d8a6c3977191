#include "diagnose/search/proof.h"

#include <memory>
#include <utility>

#include "diagnose/data/thinned.h"
#include "diagnose/fit/held_out.h"
#include "diagnose/fit/start_fit.h"
#include "diagnose/search/horizon_score.h"
#include "diagnose/search/window_search.h"

namespace hydro::diagnose {

namespace {

// How many explanations that lead on windows are tried on whole runs.
constexpr size_t kMostProved = 5;
// Above this squared gap of whole runs, their drift says less than windows do.
constexpr double kNearTheNoise = 9;
// From so many fitted runs on, the held-out runs choose nothing.
constexpr size_t kFewestToChoose = 2;

// Fits the hypothesis to the whole runs; from other starts too where it leaves a small gap, which another start
// may close.
Explanation Prove(const SearchContext& context, const Hypothesis& hypothesis) {
  constexpr double kSmall = 4;
  const FitOptions compare = FitToCompare(context.jobs);
  const Explanation one = Explain(context, hypothesis, MeasuredStarts(context.runs), compare);
  const bool small = one.fitted.ok() && one.squared_gap() < kSmall;
  return small && !TimeIsUp(context) ? RefitFromBestStarts(context, one, compare) : one;
}

WindowTrials TrialsOn(SearchWindows windows, const WideSearch& near, bool decide) {
  WindowTrials trials;
  trials.tried = near.search.tried;
  for (const Explanation* one : {&near.search.given, &near.search.best, &near.refit})
    trials.tried.push_back(*one);
  trials.runs.reserve(windows.choosing.size());
  for (const RunData* window : windows.choosing) trials.runs.push_back(window->name);
  trials.decide = decide;
  trials.best = near.search.best.fitted;
  trials.fitted = std::move(windows.fitted);
  trials.choosing = std::move(windows.choosing);
  // A vector that is moved keeps its elements where they are.
  trials.all = std::make_shared<const std::vector<RunData>>(std::move(windows.all));
  return trials;
}

// Continues from the best explanation on the whole runs.
void SearchOn(const SearchContext& context, SearchResult* proved) {
  const int changes = static_cast<int>(proved->best.changes().size());
  if (changes >= kMostChanges) return;
  // Windows have tried all. What shows on whole runs alone, an offset or a drift, is linear: a race shows half of its gain at least.
  const Fitted from = proved->best.fitted;
  const double least = 1 - 0.5 * LeastMaterialGain(from.squared_gap()) / from.squared_gap();
  SearchResult more = Search(context, proved->best, {kMostChanges - changes, false, {&from, least}});
  proved->best = std::move(more.best);
  proved->tried.insert(proved->tried.end(), more.tried.begin(), more.tried.end());
}

// Predicts the held-out runs, which have chosen nothing, with all else that was compared.
void PredictHeldOut(const SearchContext& context, WideSearch* proved) {
  const auto predict = [&](Explanation* one) {
    if (one->blocks.sums.empty()) return;
    one->held_out = Predict(one->fitted, context.held_out, context.jobs);
    one->blocks = BlocksOf(context.held_out, one->held_out);
  };
  for (Explanation& one : proved->search.tried) predict(&one);
}

// The hypothesis as fitted to the whole runs, thinned: where the noise is far, every sample is more than it takes.
Explanation FittedToWholeRuns(const SearchContext& context, const Hypothesis& hypothesis,
                              const std::vector<model::StartState>& starts, const FitOptions& held) {
  std::vector<RunData> thinned;
  for (const RunData* run : context.runs) thinned.push_back(ThinnedCopy(*run));
  Explanation whole;
  FitOptions coarse = FineFit(context.jobs);
  coarse.tolerance = 1e-3;
  whole.fitted = Fit(hypothesis, PointersTo(thinned), starts, coarse);
  return whole.fitted.ok() ? Explain(context, whole.fitted.hypothesis, StartsOf(whole.fitted), held) : whole;
}

// The hypothesis with the better of two values: as fitted to windows and to the whole runs, by what they predict
// over several horizons. Values of windows are told from held-out runs alone.
Explanation WithBetterValues(const SearchContext& context, const Fitted& on_windows) {
  const std::vector<model::StartState> measured = MeasuredStarts(context.runs);
  FitOptions held;
  held.most_iterations = 0;
  held.jobs = context.jobs;
  Explanation whole = FittedToWholeRuns(context, on_windows.hypothesis, measured, held);
  if (context.held_out.empty()) return whole;
  const std::vector<model::StartState> starts =
      BestStarts(on_windows.hypothesis, context.runs, measured, context.jobs);
  Explanation kept = Explain(context, on_windows.hypothesis, starts, held);
  if (!whole.fitted.ok() || !kept.fitted.ok()) return kept.fitted.ok() ? kept : whole;
  const double seconds = SearchHorizon(context.runs);
  const auto score = [&](const Explanation& one) {
    return HorizonScore(one.fitted.hypothesis.model, context.runs, seconds, context.jobs);
  };
  return score(kept) < score(whole) ? kept : whole;
}

// Fits what leads on windows to the whole runs, and chooses.
void Choose(const SearchContext& context, const SearchResult& near, WideSearch* proved) {
  for (const Explanation* one : Leading(near, kMostProved)) {
    if (TimeIsUp(context) && !proved->search.tried.empty()) break;
    Explanation whole = Prove(context, one->fitted.hypothesis);
    if (!whole.fitted.ok()) continue;
    if (Material(proved->search.best.held_out_gap(), whole.held_out_gap())) proved->search.best = whole;
    proved->search.tried.push_back(std::move(whole));
    if (proved->search.best.held_out_gap() > kNearTheNoise) return;
  }
  if (TimeIsUp(context)) return;
  const bool open = !LeavesNothing(context, proved->search.best, kCloseEnough);
  if (open) {
    SearchOn(context, &proved->search);
  } else {
    Settle(context, &proved->search.best);
  }
}

// The explanations of the whole runs: those given, refitted, and near the noise the best of what leads on windows.
WideSearch ProveInTurn(const SearchContext& context, const Hypothesis& as_given, const WideSearch& near) {
  // Where runs are enough, they choose by predicting each other.
  const bool in_turn = context.runs.size() >= kFewestToChoose && !context.held_out.empty();
  SearchContext choosing = context;
  std::vector<RunData> thinned;
  if (!in_turn && !context.held_out.empty()) {
    // One fitted run chooses too: the other may not move what differs.
    choosing.held_out.insert(choosing.held_out.begin(), context.runs.begin(), context.runs.end());
  } else if (in_turn) {
    // The values are fitted to all samples when the choice has been made.
    for (const RunData* run : context.runs) thinned.push_back(ThinnedCopy(*run));
    choosing.runs = PointersTo(thinned);
    choosing.held_out.clear();
  }
  const std::vector<model::StartState> measured = MeasuredStarts(context.runs);
  WideSearch proved;
  proved.search.given = Explain(choosing, as_given, measured, FineFit(context.jobs));
  if (!proved.search.given.fitted.ok()) return proved;
  proved.search.rated = near.search.rated;
  proved.search.best = proved.search.given;
  proved.refit = Explain(choosing, near.refit.fitted.hypothesis, measured, FitToCompare(context.jobs));
  if (!proved.refit.fitted.ok()) proved.refit = proved.search.given;
  Choose(choosing, near.search, &proved);
  if (!context.held_out.empty()) {
    for (Explanation* one : {&proved.search.given, &proved.refit, &proved.search.best}) Settle(context, one);
    PredictHeldOut(context, &proved);
  }
  return proved;
}

// The explanations of the whole runs where no model comes near the noise: windows have chosen.
WideSearch TakeFromWindows(const SearchContext& context, const Hypothesis& as_given, const WideSearch& near) {
  WideSearch taken;
  taken.search.given = Explain(context, as_given, MeasuredStarts(context.runs), FineFit(context.jobs));
  if (!taken.search.given.fitted.ok()) return taken;
  taken.search.rated = near.search.rated;
  taken.refit = WithBetterValues(context, near.refit.fitted);
  if (!taken.refit.fitted.ok()) taken.refit = taken.search.given;
  taken.search.best = near.search.best.changes().empty() && near.search.best.fitted.hypothesis.base.empty()
                          ? taken.search.given
                          : WithBetterValues(context, near.search.best.fitted);
  if (!taken.search.best.fitted.ok()) taken.search.best = taken.search.given;
  taken.search.tried = {taken.refit, taken.search.best};
  return taken;
}

}  // namespace

std::string ProofRemark(const SearchContext& context) {
  if (!context.held_out.empty() && context.runs.size() >= kFewestToChoose) return "";
  const std::string chosen = context.held_out.empty()
                                 ? "Each run was predicted from the others, and these predictions also chose"
                                 : "What was held out also chose, as only one run was fitted";
  return chosen + ": for a proof, fit two runs or more and name another with --hold-out";
}

WideSearch SearchAndProve(const SearchContext& context, const Hypothesis& as_given,
                          const std::vector<size_t>& allowed) {
  SearchWindows windows = WindowsForSearch(context.runs, context.given.parameters);
  const WideSearch near =
      windows.choosing.empty()
          ? WideSearch{}
          : SearchWidely(OnWindows(context, windows.fitted, windows.choosing), as_given, allowed);
  if (windows.choosing.empty() || !near.search.given.fitted.ok()) {
    return SearchWidely(context, as_given, allowed);
  }
  if (context.report_progress) context.report_progress({"fitting the whole runs", 0.93});
  WideSearch proved;
  if (near.search.best.held_out_gap() < kOutOfReach) proved = ProveInTurn(context, as_given, near);
  const bool far = proved.search.tried.empty() || proved.search.best.held_out_gap() >= kNearTheNoise;
  if (far) proved = TakeFromWindows(context, as_given, near);
  proved.windows = TrialsOn(std::move(windows), near, far);
  return proved;
}

}  // namespace hydro::diagnose
