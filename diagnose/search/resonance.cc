#include "diagnose/search/resonance.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "diagnose/search/predicting_starts.h"

namespace hydro::diagnose {

namespace {

// Where refits begin: differences of the frequency's logarithm from where the last fit ended. Ringing that
// lasts a tenth of a second distinguishes frequencies some 2 % apart at 300 Hz.
constexpr std::array<double, 10> kElsewhere = {-0.22, -0.15, -0.1, -0.06, -0.03, 0.03, 0.06, 0.1, 0.15, 0.22};
constexpr size_t kFitted = 4;  // of these, those that predict best
constexpr int kRounds = 3;

Hypothesis Moved(const Hypothesis& hypothesis, size_t place, double by) {
  std::vector<double> values;
  for (const FreeParameter& parameter : hypothesis.Free()) values.push_back(parameter.value);
  values[place] *= std::exp(by);
  Hypothesis moved = hypothesis;
  moved.Set(values);
  return moved;
}

// The fit begun at the best place around where this one ended, which is told from fits that hold the model's own parameters;
// this one itself where it is no better.
Fitted BestAround(const SearchContext& context, const Fitted& fitted, size_t place,
                  const FitOptions& options) {
  FitOptions alone = options;
  alone.jobs = 1;
  std::vector<Hypothesis> around;
  for (const double by : kElsewhere) {
    around.push_back(Moved(fitted.hypothesis, place, by));
    around.back().base.clear();
  }
  const std::vector<Scanned> starts = PredictingStarts(context, {}, around, StartsOf(fitted), fitted, kFitted,
                                                       std::numeric_limits<double>::infinity());
  std::vector<Fitted> fits(starts.size());
  ParallelFor(fits.size(), context.jobs,
              [&](size_t i) { fits[i] = Fit(starts[i].start, context.runs, starts[i].run_starts, alone); });
  const Fitted* best = nullptr;
  for (const Fitted& fit : fits) {
    if (fit.ok() && (best == nullptr || fit.sum < best->sum)) best = &fit;
  }
  if (best == nullptr) return fitted;
  Hypothesis from = fitted.hypothesis;
  from.model = best->hypothesis.model;
  Fitted refitted = Fit(from, context.runs, StartsOf(*best), options);
  return refitted.ok() && refitted.sum < fitted.sum ? refitted : fitted;
}

}  // namespace

Explanation AtBestResonance(const SearchContext& context, const Explanation& one, const FitOptions& options) {
  FitOptions coarse = options;
  coarse.most_iterations = 8;
  coarse.tolerance = 1e-3;
  Explanation best = one;
  const std::vector<FreeParameter> free = one.fitted.hypothesis.Free();
  for (size_t place = 0; place < free.size(); ++place) {
    if (free[place].role != model::Role::kFrequency) continue;
    for (int round = 0; round < kRounds && !TimeIsUp(context); ++round) {
      const Fitted other = BestAround(context, best.fitted, place, coarse);
      if (!(other.sum < best.fitted.sum)) break;
      Explanation explained = Explain(context, other.hypothesis, StartsOf(other), options);
      if (!explained.fitted.ok() || !(explained.fitted.sum < best.fitted.sum)) break;
      const bool little = explained.fitted.sum > 0.999 * best.fitted.sum;
      best = std::move(explained);
      if (little) break;
    }
  }
  return best;
}

}  // namespace hydro::diagnose
