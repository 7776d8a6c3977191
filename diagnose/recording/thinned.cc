#include "diagnose/recording/thinned.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"

namespace hydro::diagnose {
namespace {

constexpr double kFinest = 1e-3;        // s between samples
constexpr size_t kFewestOfARun = 1000;  // samples

}  // namespace

void Thin(size_t fewest, RunData* run) {
  model::Stimulus& stimulus = run->stimulus;
  const size_t samples = stimulus.time.size();
  if (samples < 2) return;
  const double interval = run->duration() / static_cast<double>(samples - 1);
  const auto by_time = static_cast<size_t>(1.001 * kFinest / interval);
  const size_t step = std::min(by_time, samples / std::max<size_t>(fewest, 1));
  if (step < 2) return;
  const maths::Range range = maths::RangeOf(stimulus.voltage);
  const double jump = kStepOfCommand * range.size();
  size_t kept = 0;
  for (size_t i = 0; i < samples; ++kept) {
    double sum = stimulus.voltage[i];
    size_t end = i + 1;
    for (; end < std::min(i + step, samples); ++end) {
      if (std::abs(stimulus.voltage[end] - stimulus.voltage[end - 1]) > jump) break;
      sum += stimulus.voltage[end];
    }
    stimulus.time[kept] = stimulus.time[i];
    if (!stimulus.around.empty()) stimulus.around[kept] = stimulus.around[i];
    stimulus.voltage[kept] = sum / static_cast<double>(end - i);
    for (SignalData& signal : run->signals) signal.values[kept] = signal.values[i];
    i = end;
  }
  run->most_steps_per_sample *= static_cast<double>(samples) / static_cast<double>(kept);
  stimulus.time.resize(kept);
  stimulus.voltage.resize(kept);
  if (!stimulus.around.empty()) stimulus.around.resize(kept);
  for (SignalData& signal : run->signals) {
    signal.values.resize(kept);
    signal.valid = CountValid(signal.values);
  }
}

RunData ThinnedCopy(const RunData& run) {
  RunData copy;
  copy.name = run.name;
  copy.stimulus = run.stimulus;
  copy.angle_counts = run.angle_counts;
  copy.begins_within = run.begins_within;
  copy.start = run.start;
  copy.start_free = run.start_free;
  copy.start_error = run.start_error;
  copy.signals = run.signals;
  copy.most_steps_per_sample = run.most_steps_per_sample;
  Thin(kFewestOfARun, &copy);
  return copy;
}

}  // namespace hydro::diagnose
