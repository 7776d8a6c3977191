#include "diagnose/fit/check_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "diagnose/data/run_data.h"
#include "diagnose/data/run_start.h"
#include "diagnose/data/sample_interval.h"
#include "diagnose/data/smoothed_motion.h"
#include "diagnose/fit/fit.h"
#include "diagnose/fit/residuals.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kSeconds = 0.05;  // of a window, within these numbers of samples
constexpr double kShortestCheck = 40, kLongest = 200;
constexpr size_t kFewestOfACheck = 12;  // of a signal in a window
// A prediction need not be better than this share of the movement in the window, and of that in the run.
constexpr double kOfWindow = 0.1, kOfRun = 0.01;
constexpr double kMoves = 4;  // times the noise

constexpr std::array kAll = {model::Channel::kMotorAngle, model::Channel::kMotorSpeed,
                             model::Channel::kArmAngle,   model::Channel::kArmSpeed,
                             model::Channel::kP1,         model::Channel::kP2};

bool IsAngle(model::Channel channel) {
  return channel == model::Channel::kMotorAngle || channel == model::Channel::kArmAngle;
}

template <class AnyRun>
auto& In(AnyRun& run, model::Channel channel) {
  return run.*SignalOf(channel).signal;
}

// The standard deviation of the values about their mean, or about a straight line; 0 for fewer than two.
double Movement(const std::vector<double>& values, size_t first, size_t last, bool about_line) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  const double middle = 0.5 * static_cast<double>(first + last);
  double origin = std::numeric_limits<double>::quiet_NaN();
  for (size_t i = first; i < last; ++i) {
    if (std::isnan(values[i])) continue;
    if (std::isnan(origin)) origin = values[i];
    const double at = static_cast<double>(i) - middle, value = values[i] - origin;
    n += 1, x += at, y += value, xx += at * at, xy += at * value, yy += value * value;
  }
  if (n < 3) return 0;
  double square = yy - y * y / n;
  const double spread = xx - x * x / n, slope = xy - x * y / n;
  if (about_line && spread > 0) square -= slope * slope / spread;
  return std::sqrt(std::max(0.0, square / n));
}

double Movement(const Run& run, model::Channel channel, size_t first, size_t last) {
  return Movement(In(run, channel).values, first, last, IsAngle(channel));
}

// The run with the noise of its signals estimated, and a little of their movement added. It does not say which
// line of its file a sample is from.
Run WithErrors(Run run) {
  run.lines.clear();
  for (const model::Channel channel : kAll) {
    runs::MeasuredSignal& signal = In(run, channel);
    if (!signal.measured()) continue;
    const double movement = Movement(signal.values, 0, signal.values.size(), false);
    signal.noise =
        std::max(std::hypot(EstimateNoise(signal.values), IsAngle(channel) ? 0 : kOfRun * movement), 1e-12);
  }
  return run;
}

// 0 where nothing moves by more than noise.
double MovementOfAll(const Run& run, size_t first, size_t last) {
  double sum = 0, most = 0;
  for (const model::Channel channel : kAll) {
    if (!IsCompared(run, channel)) continue;
    const double moves = Movement(run, channel, first, last) / In(run, channel).noise.value();
    sum += std::log1p(moves * moves);
    most = std::max(most, moves);
  }
  return most > kMoves ? sum : 0;
}

SignalData SignalIn(const Run& window, model::Channel channel) {
  const runs::MeasuredSignal& measured = In(window, channel);
  SignalData signal;
  signal.channel = channel;
  signal.values = measured.values;
  signal.valid = CountValid(signal.values);
  const double movement = Movement(window, channel, 0, signal.values.size());
  signal.noise = std::hypot(measured.noise.value_or(0), kOfWindow * movement);
  return signal;
}

RunData DataOf(const Run& window, const model::Parameters& model) {
  RunData data;
  data.name = window.name;
  data.stimulus = StimulusOf(window);
  for (const model::Channel channel : kAll) {
    if (!IsCompared(window, channel)) continue;
    SignalData signal = SignalIn(window, channel);
    if (signal.valid >= kFewestOfACheck && !std::isnan(signal.values[0]))
      data.signals.push_back(std::move(signal));
  }
  if (window.shaft == model::Shaft::kDriven) {
    data.motion = SmoothMotion(window.time, window.arm_angle.values, window.arm_angle.noise.value_or(0),
                               window.arm_speed.values, window.arm_speed.noise.value_or(0));
    data.stimulus.motion = data.motion.get();
  }
  if (!data.signals.empty()) SetStart(model, &data);
  return data;
}

}  // namespace

std::vector<Run> MovingWindows(const Run& recorded, size_t most) {
  const Run run = WithErrors(recorded);
  const double interval = MedianInterval(run.time);
  const auto length =
      static_cast<size_t>(std::lround(std::clamp(kSeconds / interval, kShortestCheck, kLongest)));
  std::vector<std::pair<double, size_t>> places;  // minus the movement, first sample
  for (size_t first = 0; first + length <= run.samples(); first += std::max<size_t>(1, length / 2)) {
    const double moves = MovementOfAll(run, first, first + length);
    if (moves > 0) places.emplace_back(-moves, first);
  }
  std::sort(places.begin(), places.end());
  std::vector<size_t> taken;
  for (const auto& [moves, first] : places) {
    if (taken.size() == most) break;
    const bool overlaps = std::any_of(taken.begin(), taken.end(), [first = first, length](size_t other) {
      return first < other + length && other < first + length;
    });
    if (!overlaps) taken.push_back(first);
  }
  std::vector<Run> windows;
  windows.reserve(taken.size());
  for (const size_t first : taken) {
    windows.push_back(run);
    windows.back().Keep(first, first + length);
  }
  return windows;
}

std::array<bool, model::kChannels> ChannelsThatMove(const Run& window) {
  std::array<bool, model::kChannels> move{};
  for (const model::Channel channel : kAll) {
    if (!IsCompared(window, channel)) continue;
    const double moves = Movement(window, channel, 0, window.samples());
    move[static_cast<size_t>(channel)] = moves > kMoves * In(window, channel).noise.value_or(0);
  }
  return move;
}

PredictionErrors PredictWindow(const model::ModelDescription& model, const Run& window, WindowStart start) {
  PredictionErrors errors;
  errors.fill(std::numeric_limits<double>::quiet_NaN());
  const RunData data = DataOf(window, model.parameters);
  for (const SignalData& signal : data.signals) errors[static_cast<size_t>(signal.channel)] = kUnpredicted;
  if (data.signals.empty()) return errors;
  model::StartState from = data.start;
  if (start == WindowStart::kFitted) {
    Hypothesis given;
    given.model = model;
    FitOptions options;
    options.most_iterations = 4;
    options.tolerance = 1e-2;
    const Fitted fitted = Fit(given, {&data}, {data.start}, options);
    if (!fitted.ok()) return errors;
    from = fitted.runs[0].start;
  }
  try {
    const Residuals residuals = ResidualsOf(model, data, from);
    for (size_t s = 0; s < data.signals.size(); ++s) {
      double sum = 0;
      for (size_t i = residuals.first[s]; i < residuals.first[s + 1]; ++i) {
        sum += residuals.values[i] * residuals.values[i];
      }
      const double count = static_cast<double>(residuals.first[s + 1] - residuals.first[s]);
      const double error = sum / count;
      errors[static_cast<size_t>(data.signals[s].channel)] = error < kUnpredicted ? error : kUnpredicted;
    }
  } catch (const model::ModelError&) {
    return errors;
  }
  return errors;
}

}  // namespace hydro::diagnose
