#include "diagnose/fit/start_fit.h"

#include <utility>

#include "base/parallel.h"

namespace hydro::diagnose {

namespace {

// A start is no result: what further steps gain does not show in a gap.
constexpr double kStartTolerance = 1e-3;

}  // namespace

Fitted FitStart(const Hypothesis& hypothesis, const RunData& run, const model::StartState& from,
                double doubtful) {
  const Hypothesis held = hypothesis.Held();
  FitOptions options;
  options.most_iterations = 12;
  options.tolerance = kStartTolerance;
  Fitted best = Fit(held, {&run}, {from}, options);
  const auto begin_at = [&](const model::StartState& start) {
    if (start == from) return;
    Fitted other = Fit(held, {&run}, {start}, options);
    if (other.ok() && (!best.ok() || other.sum < best.sum)) best = std::move(other);
  };
  if (best.ok() && best.squared_gap() <= doubtful) return best;
  begin_at(run.start);
  if (run.at_rest.has_value()) begin_at(*run.at_rest);
  return best;
}

std::vector<model::StartState> BestStarts(const Hypothesis& hypothesis,
                                          const std::vector<const RunData*>& runs,
                                          const std::vector<model::StartState>& from, int jobs) {
  std::vector<model::StartState> starts = from;
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    const Fitted best = FitStart(hypothesis, *runs[r], from[r], kStartInDoubt);
    if (best.ok()) starts[r] = best.runs[0].start;
  });
  return starts;
}

}  // namespace hydro::diagnose
