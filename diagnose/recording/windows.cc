#include "diagnose/recording/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnose/recording/thinned.h"
#include "model/terms/state.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kFewestCompared = 12;  // samples
constexpr size_t kFewestValues = 8;     // of one signal

// This share of a window is simulated before it and not compared, because the states of effects are unknown
// where it begins, for example what a lagging sensor reads.
constexpr double kWarmUp = 0.25;

// A window's simulation may take this many steps for each sample. Models that need more are stiffer than the
// samples can show.
constexpr double kStepsPerSample = 12;

// Windows of fine recordings are thinned to no fewer samples than this.
constexpr size_t kFewestKept = 100;

template <class T>
std::vector<T> Slice(const std::vector<T>& values, size_t first, size_t last) {
  return {values.begin() + static_cast<std::ptrdiff_t>(first),
          values.begin() + static_cast<std::ptrdiff_t>(last)};
}

// The motor's angle along a run in which only the speed is measured; empty if neither is.
std::vector<double> IntegratedSpeed(const RunData& run) {
  const SignalData* speed = run.Find(model::Channel::kMotorSpeed);
  if (speed == nullptr || run.Find(model::Channel::kMotorAngle) != nullptr) return {};
  const std::vector<double>& time = run.stimulus.time;
  std::vector<double> angle(time.size(), run.start[model::kMotorAngle]);
  double before = run.start[model::kMotorSpeed];
  for (size_t i = 1; i < time.size(); ++i) {
    const double now = std::isnan(speed->values[i]) ? before : speed->values[i];
    angle[i] = angle[i - 1] + 0.5 * (before + now) * (time[i] - time[i - 1]);
    before = now;
  }
  return angle;
}

RunData CutWindow(const RunData& run, size_t first, size_t compared, size_t last,
                  const std::vector<double>& motor_angle, const model::Parameters& model) {
  RunData window;
  window.name = run.name;
  window.most_steps_per_sample = kStepsPerSample;
  window.angle_counts = run.angle_counts;
  window.begins_within = first > 0;
  window.stimulus.shaft = run.stimulus.shaft;
  window.stimulus.arm_angle = run.stimulus.arm_angle;
  window.stimulus.motion = run.stimulus.motion;
  window.stimulus.bypass = run.stimulus.bypass;
  window.stimulus.begin = run.stimulus.begin;
  window.stimulus.time = Slice(run.stimulus.time, first, last);
  window.stimulus.voltage = Slice(run.stimulus.voltage, first, last);
  if (!run.stimulus.around.empty()) window.stimulus.around = Slice(run.stimulus.around, first, last);
  for (const SignalData& signal : run.signals) {
    SignalData part = signal;
    part.values = Slice(signal.values, first, last);
    part.valid = CountValid(part.values);
    if (part.valid >= kFewestValues) window.signals.push_back(std::move(part));
  }
  if (window.signals.empty()) return window;
  SetStart(model, &window);
  if (!motor_angle.empty()) {
    window.start[model::kMotorAngle] = motor_angle[first];
    window.start_error[model::kMotorAngle] = std::numeric_limits<double>::infinity();
    window.start_free[model::kMotorAngle] = true;
  }
  for (SignalData& signal : window.signals) {
    std::fill_n(signal.values.begin(), compared - first, std::numeric_limits<double>::quiet_NaN());
    signal.valid = CountValid(signal.values);
  }
  Thin(kFewestKept, &window);
  std::erase_if(window.signals, [](const SignalData& signal) { return signal.valid < kFewestValues; });
  return window;
}

}  // namespace

std::vector<RunData> WindowsOf(const RunData& run, double seconds, const model::Parameters& model) {
  const std::vector<double>& time = run.stimulus.time;
  const std::vector<double> motor_angle = IntegratedSpeed(run);
  std::vector<RunData> windows;
  size_t first = 0;
  while (first < time.size()) {
    size_t compared = first;
    while (compared < time.size() && time[compared] < time[first] + kWarmUp * seconds) ++compared;
    const double end = time[first] + (1 + kWarmUp) * seconds;
    size_t last = compared;
    while (last < time.size() && time[last] < end) ++last;
    const bool whole = last < time.size() || time.back() > end - 0.1 * seconds;
    if (!whole) break;
    if (last - compared >= kFewestCompared) {
      RunData window = CutWindow(run, first, compared, last, motor_angle, model);
      if (!window.signals.empty()) windows.push_back(std::move(window));
    }
    // The next window's comparison begins where this one's ends.
    const double next = end - kWarmUp * seconds;
    while (first < last && time[first] < next) ++first;
  }
  return windows;
}

std::vector<RunData> WindowsOf(const std::vector<const RunData*>& runs, double seconds,
                               const model::Parameters& model) {
  std::vector<RunData> windows;
  for (const RunData* run : runs) {
    for (RunData& window : WindowsOf(*run, seconds, model)) windows.push_back(std::move(window));
  }
  return windows;
}

std::vector<const RunData*> EvenlySpread(const std::vector<RunData>& windows, size_t most, size_t first,
                                         size_t stride) {
  std::vector<const RunData*> all;
  for (size_t i = first; i < windows.size(); i += stride) all.push_back(&windows[i]);
  if (all.size() <= most) return all;
  std::vector<const RunData*> some;
  for (size_t k = 0; k < most; ++k) some.push_back(all[k * all.size() / most]);
  return some;
}

}  // namespace hydro::diagnose
