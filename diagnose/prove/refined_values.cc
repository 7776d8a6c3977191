#include "diagnose/prove/refined_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/maths/spread.h"
#include "diagnose/fit/fit.h"
#include "diagnose/fit/likeliest_scale.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/thinned.h"

namespace hydro::diagnose {
namespace {

// If a round reduces the sum of squares by less than this part, another round is not worthwhile.
constexpr double kWorthARound = 0.02;
constexpr double kStepTolerance = 1e-3;
// Relative to the median window's rms: a window's remainder counts up to this factor.
constexpr double kMostOfTheMedian = 3;

// What the model leaves of each channel in the median window; at least the noise.
std::array<double, model::kChannels> MedianSquares(const std::vector<WindowGap>& gaps) {
  std::array<double, model::kChannels> medians;
  for (size_t c = 0; c < model::kChannels; ++c) {
    std::vector<double> squares;
    for (const WindowGap& gap : gaps) {
      if (gap.tested && !std::isnan(gap.squared[c])) squares.push_back(gap.squared[c]);
    }
    medians[c] = squares.empty() ? 1 : std::max(1.0, maths::Median(std::move(squares)));
  }
  return medians;
}

// The windows as the model leaves them, without derivatives.
Fitted AsItIs(const Hypothesis& hypothesis, const std::vector<const RunData*>& windows, int jobs) {
  Fitted fitted;
  fitted.hypothesis = hypothesis;
  for (const WindowGap& gap : GapsOfEach(hypothesis.model, windows, jobs)) {
    if (!gap.tested) fitted.failure = "its simulation fails";
    fitted.runs.push_back({gap.start, gap.sum, gap.count, {}, {}});
    fitted.sum += gap.sum;
    fitted.count += gap.count;
  }
  return fitted;
}

}  // namespace

std::vector<RunData> WithDiscrepancy(const std::vector<const RunData*>& windows,
                                     const model::ModelDescription& model, int jobs) {
  const std::vector<WindowGap> gaps = GapsOfEach(model, windows, jobs);
  const std::array<double, model::kChannels> medians = MedianSquares(gaps);
  std::vector<RunData> scaled;
  for (size_t w = 0; w < windows.size(); ++w) {
    if (!gaps[w].tested) continue;
    scaled.push_back(ThinnedCopy(*windows[w]));
    for (SignalData& signal : scaled.back().signals) {
      const auto c = static_cast<size_t>(signal.channel);
      const double own = gaps[w].squared[c] / (kMostOfTheMedian * kMostOfTheMedian);
      signal.noise *= std::sqrt(std::max(medians[c], own));
    }
  }
  return scaled;
}

std::shared_ptr<const Knowledge> KnownOfValues(const ProofContext& context,
                                               const std::vector<const RunData*>& windows,
                                               const Hypothesis& hypothesis, double sum) {
  const auto named =
      std::ranges::count_if(hypothesis.changes, [](const Change& change) { return change.effect.empty(); });
  return hypothesis.base.size() > static_cast<size_t>(named) ? KnownAt(context.given, windows, sum) : nullptr;
}

std::vector<model::StartState> CorrectedStarts(const model::ModelDescription& model,
                                               const std::vector<const RunData*>& windows, int jobs) {
  const std::vector<WindowGap> gaps = GapsOfEach(model, windows, jobs);
  std::vector<model::StartState> starts;
  for (size_t w = 0; w < windows.size(); ++w)
    starts.push_back(gaps[w].tested ? gaps[w].start : windows[w]->start);
  return starts;
}

void RefineValues(const ProofContext& context, const std::vector<const RunData*>& fitted,
                  const ProofWindows& windows, const Refinement& limits, ProvedSet* set) {
  if (fitted.empty() || set->hypothesis.Free().empty()) return;
  FitOptions options;
  options.tolerance = kStepTolerance;
  options.jobs = context.jobs;
  options.most_iterations = limits.steps;
  options.line_search = limits.line_search;
  options.at_turn = true;
  Fitted at = AsItIs(set->hypothesis, fitted, context.jobs);
  for (int round = 0; round < limits.rounds && at.ok() && !TimeIsUp(context); ++round) {
    Hypothesis from = at.hypothesis;
    from.known = KnownOfValues(context, fitted, from, at.sum);
    const double before = at.sum;
    at = Fit(from, fitted, StartsOf(at), options);
    if (!at.ok() || !(at.sum < before)) return;
    MoveToLikeliestScale(context.given, &at.hypothesis);
    ProvedSet refined = *set;
    refined.hypothesis = at.hypothesis;
    refined.UseOneModel();
    JudgeSet(windows, context.jobs, &refined);
    if (PredictsBetter(windows, context.jobs, &refined, set)) *set = std::move(refined);
    if (at.sum > (1 - kWorthARound) * before) return;
  }
}

}  // namespace hydro::diagnose
