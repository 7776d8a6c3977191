#include "runs/slow_samples.h"

#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/maths/median.h"
#include "base/number_text.h"

namespace hydro::runs {

std::string TimeUnitHint(double interval) {
  constexpr double kFastestSamples = 2e-5, kUsualSamples = 0.1;  // s
  if (interval <= kSlowestSamples) return "";
  for (const auto& [unit, size] : {std::pair("ms", 1e-3), std::pair("us", 1e-6), std::pair("ns", 1e-9)}) {
    if (interval * size < kFastestSamples || interval * size > kUsualSamples) continue;
    return std::string(" (is the column in ") + unit + "? unit = \"" + unit + "\")";
  }
  return "";
}

void RequireFastSamples(const MeasuredRun& run) {
  std::vector<double> intervals;
  for (size_t i = 1; i < run.samples(); ++i) intervals.push_back(run.time[i] - run.time[i - 1]);
  const double interval = intervals.empty() ? 0 : maths::Median(std::move(intervals));
  if (interval <= kSlowestSamples) return;
  throw InputError(run.file + ": time: found rows " + ShortNumber(interval) + " s apart, allowed at most " +
                   ShortNumber(kSlowestSamples) + " s: slower ones show no motion of such a machine" +
                   TimeUnitHint(interval));
}

}  // namespace hydro::runs
