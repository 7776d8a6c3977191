#include "diagnose/fit/held_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "diagnose/fit/start_fit.h"

namespace hydro::diagnose {

double LogarithmOf(double squared_gap) { return std::log(std::clamp(squared_gap, 1e-3, 1e12)); }

double HeldOut::typical_squared_gap() const {
  double logarithms = 0;
  for (const double gap : gaps) logarithms += LogarithmOf(gap);
  return gaps.empty() ? 0 : std::exp(logarithms / static_cast<double>(gaps.size()));
}

HeldOut Predict(const Fitted& fitted, const std::vector<const RunData*>& held_out, int jobs) {
  HeldOut all;
  all.gaps.resize(held_out.size());
  ParallelFor(held_out.size(), jobs, [&](size_t r) {
    const Fitted one = FitStart(fitted.hypothesis, *held_out[r], held_out[r]->start, kStartInDoubt);
    all.gaps[r] = one.ok() ? one.squared_gap() : std::numeric_limits<double>::infinity();
  });
  for (const RunData* run : held_out) all.count += CountValid(*run);
  return all;
}

}  // namespace hydro::diagnose
