#include "diagnose/prove/proof_outcome.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/parallel.h"
#include "diagnose/fit/fit.h"
#include "diagnose/prove/refined_values.h"
#include "diagnose/search/window_search.h"

namespace hydro::diagnose {

namespace {

constexpr char kNotTested[] = "it cannot be simulated over the held-out windows";

// Where nothing can be simulated: as bad as infinity, but comparable.
constexpr double kFarOff = 1e12;

// Keeps all windows of a proof where they are.
struct OwnedWindows {
  std::shared_ptr<const std::vector<RunData>> judging;
  std::vector<RunData> fitted;
};

// The runs or windows as the model leaves them. Sums are those of what can be simulated, as if all could.
Fitted FittedTo(const Hypothesis& hypothesis, const std::vector<const RunData*>& runs, int jobs) {
  std::vector<WindowGap> gaps(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { gaps[r] = GapOf(hypothesis.model, *runs[r]); });
  Fitted fitted;
  fitted.hypothesis = hypothesis;
  size_t simulated = 0;
  for (size_t r = 0; r < runs.size(); ++r) {
    RunFit run;
    run.start = gaps[r].tested ? gaps[r].start : runs[r]->start;
    run.sum = gaps[r].tested ? gaps[r].sum : 0;
    run.count = CountValid(*runs[r]);
    fitted.sum += run.sum;
    fitted.count += run.count;
    simulated += gaps[r].tested ? run.count : 0;
    fitted.runs.push_back(std::move(run));
  }
  fitted.sum *= simulated > 0 ? static_cast<double>(fitted.count) / static_cast<double>(simulated) : 0;
  if (simulated == 0) fitted.sum = std::numeric_limits<double>::infinity();
  return fitted;
}

void AddPrediction(const WindowGap& gap, double squared_gap, const model::ModelDescription& model,
                   const RunData& run, HeldOut* held_out) {
  held_out->gaps.push_back(squared_gap);
  const size_t count = CountValid(run);
  held_out->sum += gap.tested ? gap.sum : squared_gap * static_cast<double>(count);
  held_out->count += count;
  held_out->starts.push_back(gap.tested ? gap.start : run.start);
  held_out->models.push_back(model);
}

Explanation OnProofWindows(const SearchContext& context, const JudgingWindows& near,
                           const std::vector<const RunData*>& fitted, const ProvedSet& set,
                           const ProvedSet& given) {
  Explanation one;
  one.windows = true;
  one.fitted = FittedTo(set.hypothesis, fitted, context.jobs);
  for (size_t w = 0; w < near.windows.size(); ++w) {
    const WindowGap& gap = set.near[w].tested ? set.near[w] : given.near[w];
    AddPrediction(set.near[w], gap.tested ? gap.Typical() : kFarOff, set.ModelOf(near.runs[w]),
                  *near.windows[w], &one.held_out);
  }
  one.blocks = LogarithmsOf(one.held_out);
  return one;
}

// Adds what the windows' fit says of its numbers to the runs that they are from.
void AddInformation(const Fitted& of_windows, const std::vector<const RunData*>& windows,
                    const std::vector<const RunData*>& runs, Fitted* fitted) {
  const size_t p = fitted->hypothesis.Free().size();
  for (size_t r = 0; r < runs.size(); ++r) {
    RunFit& to = fitted->runs[r];
    to.information.assign(p * p, 0.0);
    to.gradient.assign(p, 0.0);
    for (size_t w = 0; w < of_windows.runs.size(); ++w) {
      const RunFit& from = of_windows.runs[w];
      if (windows[w]->name != runs[r]->name || from.information.size() != p * p) continue;
      for (size_t i = 0; i < p * p; ++i) to.information[i] += from.information[i];
      for (size_t i = 0; i < p; ++i) to.gradient[i] += from.gradient[i];
    }
  }
}

// The set over whole runs; infinite where it cannot follow one.
Explanation OnWholeRuns(const SearchContext& context, const ProvedSet& set, const WindowTrials& trials) {
  Explanation one;
  one.fitted = FittedTo(set.hypothesis, context.runs, context.jobs);
  AddInformation(trials.best, trials.fitted, context.runs, &one.fitted);
  const std::vector<const RunData*>& predicted = context.predicted();
  std::vector<WindowGap> gaps(predicted.size());
  ParallelFor(predicted.size(), context.jobs,
              [&](size_t r) { gaps[r] = GapOf(set.ModelOf(r), *predicted[r]); });
  for (size_t r = 0; r < predicted.size(); ++r) {
    const double squared_gap = gaps[r].tested ? gaps[r].sum / static_cast<double>(gaps[r].count)
                                              : std::numeric_limits<double>::infinity();
    AddPrediction(gaps[r], squared_gap, set.ModelOf(r), *predicted[r], &one.held_out);
  }
  one.blocks = BlocksOf(predicted, one.held_out);
  return one;
}

// The windows' fit at the best set's values, with derivatives and what is known: how well the numbers are known.
Fitted WithDerivatives(const SearchContext& context, const ProvedSet& best,
                       const std::vector<const RunData*>& fitted) {
  FitOptions held;
  held.most_iterations = 0;
  held.jobs = context.jobs;
  Hypothesis hypothesis = best.hypothesis;
  hypothesis.known = KnownOfValues(OnWindows(context, fitted, {}), hypothesis,
                                   FittedTo(hypothesis, fitted, context.jobs).sum);
  return Fit(hypothesis, fitted, CorrectedStarts(hypothesis.model, fitted, context.jobs), held);
}

std::vector<Rated> RatedBy(const SearchContext& context, const std::vector<ProvedSet>& sets, size_t given) {
  std::vector<Rated> all;
  for (const Change& change : context.changes) {
    Rated rated{change, 0, ""};
    for (const ProvedSet& set : sets) {
      if (set.hypothesis.changes != std::vector{change}) continue;
      if (!set.tested()) rated.failure = kNotTested;
      if (set.tested() && sets[given].tested())
        rated.expected = std::max(0.0, TypicalGap(sets[given].near) - TypicalGap(set.near));
    }
    all.push_back(std::move(rated));
  }
  return all;
}

}  // namespace

WideSearch OutcomeOf(const SearchContext& context, const ProofWindows& windows, std::vector<RunData> fitted,
                     const std::vector<ProvedSet>& sets, const ProofRoles& roles) {
  WideSearch outcome;
  const auto owned = std::make_shared<const OwnedWindows>(OwnedWindows{windows.all, std::move(fitted)});
  WindowTrials& trials = outcome.windows;
  trials.all = std::shared_ptr<const std::vector<RunData>>(owned, &owned->fitted);
  trials.choosing = windows.near.windows;
  for (const RunData* window : windows.near.windows) trials.runs.push_back(window->name);
  for (const RunData& window : owned->fitted) {
    if (GapOf(sets[roles.best].hypothesis.model, window).tested) trials.fitted.push_back(&window);
  }
  if (!trials.fitted.empty()) trials.best = WithDerivatives(context, sets[roles.best], trials.fitted);
  trials.decide = trials.best.ok() && !trials.fitted.empty();
  for (const ProvedSet& set : sets) {
    if (!trials.decide || !set.tested()) continue;
    trials.tried.push_back(OnProofWindows(context, windows.near, trials.fitted, set, sets[roles.given]));
  }
  outcome.search.given = OnWholeRuns(context, sets[roles.given], trials);
  outcome.refit = OnWholeRuns(context, sets[roles.values], trials);
  outcome.search.best = OnWholeRuns(context, sets[roles.best], trials);
  if (!sets[roles.best].tested()) outcome.search.given.fitted.failure = kNotTested;
  if (trials.decide) outcome.search.best.fitted.hypothesis.known = trials.best.hypothesis.known;
  outcome.search.tried = {outcome.refit, outcome.search.best};
  outcome.search.rated = RatedBy(context, sets, roles.given);
  return outcome;
}

}  // namespace hydro::diagnose
