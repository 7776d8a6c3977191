#include "diagnose/fit/start_fit.h"

#include <utility>

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

}  // namespace hydro::diagnose
