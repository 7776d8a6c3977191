#include "diagnose/search/horizon_score.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "diagnose/data/windows.h"
#include "diagnose/fit/held_out.h"
#include "diagnose/fit/start_fit.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kMostOfAHorizon = 16;  // of each horizon

// The mean over one horizon's windows; NaN where the runs are shorter than the horizon.
double Score(const Hypothesis& hypothesis, const std::vector<const RunData*>& runs, double seconds,
             int jobs) {
  const std::vector<RunData> windows = WindowsOf(runs, seconds, hypothesis.model.parameters);
  const std::vector<const RunData*> chosen = EvenlySpread(windows, kMostOfAHorizon);
  std::vector<double> logarithms(chosen.size());
  ParallelFor(chosen.size(), jobs, [&](size_t w) {
    const Fitted fitted = FitStart(hypothesis, *chosen[w], chosen[w]->start, kStartInDoubt);
    const double gap = fitted.ok() ? fitted.squared_gap() : std::numeric_limits<double>::infinity();
    logarithms[w] = LogarithmOf(gap);
  });
  double sum = 0;
  for (const double logarithm : logarithms) sum += logarithm;
  return sum / static_cast<double>(logarithms.size());
}

}  // namespace

double HorizonScore(const model::ModelDescription& model, const std::vector<const RunData*>& runs,
                    double seconds, int jobs) {
  Hypothesis hypothesis;
  hypothesis.model = model;
  double sum = 0;
  double horizons = 0;
  for (const double factor : kHorizonFactors) {
    const double score = Score(hypothesis, runs, factor * seconds, jobs);
    if (std::isnan(score)) continue;
    sum += score;
    horizons += 1;
  }
  return sum / std::max(1.0, horizons);
}

}  // namespace hydro::diagnose
