#include "diagnose/recording/second_sensors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/maths/linear_fit.h"
#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/sample_interval.h"
#include "diagnose/recording/sidecar_lines.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

// Relative: scales of two sensors agree better than this.
constexpr double kSensorFactor = 0.02;
// Samples and s: a filter's delay.
constexpr double kSensorLateSamples = 2, kSensorLateSeconds = 2e-3;
// s: means over this time replace derivatives of noisy signals.
constexpr double kSensorBlock = 0.1;
constexpr size_t kFewestStepsOfABlock = 4, kFewestBlocksCompared = 20;
// As a share of the variance: two sensors that have less in common do not measure one quantity.
constexpr double kNotInCommon = 0.2;

// What two sensors say of one quantity, and of how fast it changes, in consecutive blocks.
struct SensorBlocks {
  std::vector<double> second, first, rate;
  double step = 0;
};

double MeanBetween(const Run& run, const std::vector<double>& values, size_t from, size_t to) {
  double sum = 0;
  for (size_t i = from; i < to; ++i)
    sum += 0.5 * (values[i] + values[i + 1]) * (run.time[i + 1] - run.time[i]);
  return sum / (run.time[to] - run.time[from]);
}

// A pair of sensors.
struct SensorPair {
  SignalOfRun second;
  std::vector<SignalOfRun> first;  // an angle, or p1 and p2
  const char* what;                // what the first one says
  const char* first_name;
  const char* believed;
  bool set_aside;  // the second sensor is used for nothing else where it is not believed

  bool Have(const Run& run) const {
    return (run.*second).measured() &&
           std::all_of(first.begin(), first.end(), [&](SignalOfRun one) { return (run.*one).measured(); });
  }
  double First(const Run& run, size_t from, size_t to) const {
    const std::vector<double>& values = (run.*first[0]).values;
    if (first.size() == 1) return (values[to] - values[from]) / (run.time[to] - run.time[from]);
    return MeanBetween(run, (run.*first[1]).values, from, to) - MeanBetween(run, values, from, to);
  }
};

const std::vector<SensorPair>& SensorPairs() {
  static const std::vector<SensorPair> pairs = {
      {&Run::motor_speed,
       {&Run::motor_angle},
       "as fast as motor_angle turns",
       "motor_angle",
       "the angle is believed",
       true},
      {&Run::arm_speed,
       {&Run::arm_angle},
       "as fast as arm_angle moves",
       "arm_angle",
       "arm_angle is believed",
       true},
      {&Run::dp, {&Run::p1, &Run::p2}, "p2 - p1", "p1 and p2", "p1 and p2 are believed", false}};
  return pairs;
}

void AddSensorBlocks(const SensorPair& pair, const Run& run, SensorBlocks* blocks) {
  const double step = MedianInterval(run.time);
  const auto steps = std::max(kFewestStepsOfABlock, static_cast<size_t>(std::lround(kSensorBlock / step)));
  const size_t quarter = steps / 4;
  for (size_t from = quarter; from + steps + quarter < run.samples(); from += steps) {
    const size_t to = from + steps;
    const double time = run.time[to] - run.time[from];
    if (time > 2 * static_cast<double>(steps) * step) continue;  // rows are missing
    const double second = MeanBetween(run, (run.*pair.second).values, from, to);
    const double first = pair.First(run, from, to);
    const double change =
        pair.First(run, to - quarter, to + quarter) - pair.First(run, from - quarter, from + quarter);
    if (!std::isfinite(second) || !std::isfinite(first) || !std::isfinite(change)) continue;
    blocks->second.push_back(second);
    blocks->first.push_back(first);
    blocks->rate.push_back(-change / time);
  }
  blocks->step = std::max(blocks->step, step);
}

double RootMeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::optional<SecondSensor> Compared(const SensorBlocks& blocks) {
  if (blocks.first.size() < kFewestBlocksCompared) return std::nullopt;
  try {
    const maths::LinearFit fit = maths::FitLinear(
        {blocks.first, std::vector<double>(blocks.first.size(), 1.0), blocks.rate}, blocks.second);
    if (!(fit.residual_deviation < std::sqrt(kNotInCommon) * RootMeanSquare(blocks.second)))
      return std::nullopt;
    const double factor = fit.coefficients[0];
    if (!(factor > 0)) return std::nullopt;
    return SecondSensor{.factor = factor,
                        .factor_half = fit.HalfWidth95({1, 0, 0}),
                        .offset = fit.coefficients[1],
                        .offset_half = fit.HalfWidth95({0, 1, 0}),
                        .late = fit.coefficients[2] / factor,
                        .late_half = fit.HalfWidth95({0, 0, 1}) / factor};
  } catch (const std::invalid_argument&) {  // at rest, or at one speed
    return std::nullopt;
  }
}

const runs::SignalName& NameOfSignal(SignalOfRun signal) {
  return *std::find_if(runs::kSignals.begin(), runs::kSignals.end(),
                       [&](const runs::SignalName& one) { return one.signal == signal; });
}

std::string OffBy(double value, double half) {
  half = std::max(half, 1e-3 * std::abs(value));
  return maths::PlusMinus({value, value - half, value + half});
}

// `size` is the root mean square of the quantity. An offset that is small beside it is not worth a word.
std::string Text(const SensorPair& pair, const Run& run, const SecondSensor& second, double size,
                 SensorsDiffer differ) {
  const runs::SignalName& name = NameOfSignal(pair.second);
  std::string text = name.ours;
  if (differ == SensorsDiffer::kInTime)
    return text + " is " + OffBy(std::abs(second.late), second.late_half) + " s " +
           (second.late > 0 ? "later" : "earlier") + " than " + pair.first_name + ": " + pair.believed;
  text += " is " + OffBy(second.factor, second.factor_half) + " times " + pair.what;
  const bool off = std::abs(second.offset) > std::max(second.offset_half, kSensorFactor / 2 * size);
  if (off) {
    text += " and " + OffBy(std::abs(second.offset), second.offset_half) + " " + runs::UnitIn(run, name) +
            (second.offset > 0 ? " more" : " less");
  }
  text += std::string(": ") + pair.believed;
  text += pair.set_aside ? ", and the speed is left out" : ", and dp is only compared with them";
  runs::ColumnSource agrees = (run.*pair.second).source;
  if (agrees.column.empty()) return text;
  agrees.scale /= second.factor;
  agrees.offset /= second.factor;
  if (off) agrees.offset -= second.offset / second.factor;
  return text + ". This makes the two agree: " + LineOf(run, pair.second, agrees);
}

// The runs whose second sensor is the same column, and what each of them is.
struct SameSensors {
  std::vector<size_t> runs;
  SensorBlocks blocks;
};

std::vector<SameSensors> SensorsOf(const SensorPair& pair, const std::vector<Run>& runs) {
  std::vector<SameSensors> recorders;
  for (size_t r = 0; r < runs.size(); ++r) {
    if (!pair.Have(runs[r])) continue;
    const runs::ColumnSource& source = (runs[r].*pair.second).source;
    const auto same = std::find_if(recorders.begin(), recorders.end(), [&](const SameSensors& one) {
      const runs::ColumnSource& other = (runs[one.runs.front()].*pair.second).source;
      return other.column == source.column && other.scale == source.scale;
    });
    SameSensors& recorder = same == recorders.end() ? recorders.emplace_back() : *same;
    recorder.runs.push_back(r);
    AddSensorBlocks(pair, runs[r], &recorder.blocks);
  }
  return recorders;
}

}  // namespace

SensorsDiffer HowTheyDiffer(const SecondSensor& second, double size, double step) {
  if (std::abs(second.factor - 1) > kSensorFactor + second.factor_half) return SensorsDiffer::kInSize;
  if (std::abs(second.offset) > kSensorFactor * size + second.offset_half) return SensorsDiffer::kInSize;
  const bool late =
      std::abs(second.late) > std::max(kSensorLateSamples * step, kSensorLateSeconds) + second.late_half;
  return late ? SensorsDiffer::kInTime : SensorsDiffer::kNot;
}

ComparedSensors CompareSensors(const std::vector<Run>& runs) {
  ComparedSensors compared;
  for (const SensorPair& pair : SensorPairs()) {
    for (const SameSensors& recorder : SensorsOf(pair, runs)) {
      const std::optional<SecondSensor> second = Compared(recorder.blocks);
      if (!second) continue;
      const double size = RootMeanSquare(recorder.blocks.first);
      const SensorsDiffer differ = HowTheyDiffer(*second, size, recorder.blocks.step);
      if (differ == SensorsDiffer::kNot) continue;
      std::vector<std::string> names;
      for (const size_t r : recorder.runs) {
        names.push_back(runs[r].name);
        if (differ == SensorsDiffer::kInSize && pair.set_aside)
          compared.unbelieved.push_back({r, pair.second});
      }
      compared.remarks.push_back(RunsNamed(names, runs.size()) + ": " +
                                 Text(pair, runs[recorder.runs.front()], *second, size, differ));
    }
  }
  return compared;
}

void LeaveOut(const std::vector<ComparedSensors::Unbelieved>& unbelieved, const std::vector<Run*>& runs) {
  for (const ComparedSensors::Unbelieved& one : unbelieved) (runs[one.run]->*one.signal).values.clear();
}

}  // namespace hydro::diagnose
