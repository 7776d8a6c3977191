#include "diagnose/recording/second_sensors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "diagnose/recording/block_means.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording/sidecar_lines.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

// Relative: scales of two sensors agree better than this.
constexpr double kSensorFactor = 0.02;
// s: a filter's delay.
constexpr double kSensorLate = 2e-3;
// A correlation: below it, two columns are not of one quantity.
constexpr double kSameQuantity = 0.5;

// What two sensors say of one quantity, and of how fast it changes, in consecutive blocks.
struct SensorBlocks {
  std::vector<double> second, first, rate;
  double step = 0;
  double first_noise = 0;  // of a sample
};

// A pair of sensors.
struct SensorPair {
  SignalOfRun second;
  std::vector<SignalOfRun> first;  // an angle, or p1 and p2
  const char* what;                // what the first one says
  const char* first_name;
  const char* believed;
  // Balances use the second sensor: it is set aside where it is not believed, and the search for wrong signs
  // judges its sign. Of dp, nothing else would say that its sign is wrong or its column another one's.
  bool set_aside;

  bool Have(const Run& run) const {
    return (run.*second).measured() &&
           std::ranges::all_of(first, [&](SignalOfRun one) { return (run.*one).measured(); });
  }
  double First(const RunBlock& block) const {
    const Run& run = *block.run;
    return first.size() == 1 ? block.Rate(run.*first[0])
                             : block.Mean(run.*first[1]) - block.Mean(run.*first[0]);
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
  blocks->step = std::max(blocks->step, runs::MedianInterval(run.time));
  double noise = 0;
  for (const SignalOfRun one : pair.first) noise = std::hypot(noise, EstimateNoise((run.*one).values));
  blocks->first_noise = std::max(blocks->first_noise, noise);
  for (const RunBlock& block : RunBlocksOf(run)) {
    const size_t quarter = (block.last - block.first) / 4;
    if (block.first < quarter || block.last + quarter >= run.samples()) continue;
    const double second = block.Mean(run.*pair.second), first = pair.First(block);
    const double change = pair.First({&run, block.last - quarter, block.last + quarter}) -
                          pair.First({&run, block.first - quarter, block.first + quarter});
    if (!std::isfinite(second) || !std::isfinite(first) || !std::isfinite(change)) continue;
    blocks->second.push_back(second);
    blocks->first.push_back(first);
    blocks->rate.push_back(-change / block.seconds());
  }
}

double RootMeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// Whether the factor is known as well as two sensors agree anyway.
bool IsKnown(const SecondSensor& second) { return second.factor_half < kSensorFactor * second.factor; }

std::optional<SecondSensor> Compared(const SensorPair& pair, const SensorBlocks& blocks) {
  const std::optional<FittedBlocks> fit =
      FitBlocks({blocks.first, std::vector<double>(blocks.first.size(), 1.0), blocks.rate}, blocks.second);
  if (!fit.has_value()) return std::nullopt;
  const bool inverted = !pair.set_aside && fit->value[0] < -fit->half[0];
  if (!(fit->value[0] > 0) && !inverted) return std::nullopt;
  const double factor = fit->value[0], offset = fit->value[1];
  // An offset that is small beside the quantity is none.
  const bool off =
      std::abs(offset) > std::max(fit->half[1], kSensorFactor / 2 * RootMeanSquare(blocks.first));
  const double late = fit->value[2] / factor, late_half = fit->half[2] / std::abs(factor);
  return SecondSensor{.factor = factor,
                      .factor_half = fit->half[0],
                      .offset = off ? offset : 0,
                      .offset_half = fit->half[1],
                      .late = std::abs(late) > late_half ? late : 0,
                      .late_half = late_half};
}

std::string Text(const SensorPair& pair, const Run& run, const SecondSensor& second, SensorsDiffer differ) {
  const runs::SignalName& name = runs::RowOf(pair.second);
  std::string text = name.ours;
  if (differ == SensorsDiffer::kInTime)
    return text + " is " + WithHalfWidth(std::abs(second.late), second.late_half) + " s " +
           (second.late > 0 ? "later" : "earlier") + " than " + pair.first_name + ": " + pair.believed +
           (pair.set_aside ? ", and the speed is moved by that" : "");
  text += " is " + WithHalfWidth(second.factor, second.factor_half) + " times " + pair.what;
  if (second.offset != 0) {
    text += " and " + WithHalfWidth(std::abs(second.offset), second.offset_half) + " " +
            runs::UnitIn(run, name) + (second.offset > 0 ? " more" : " less");
  }
  text += std::string(": ") + pair.believed;
  text += !pair.set_aside ? std::string(second.factor < 0 ? ", if they are not exchanged" : "") +
                                ", and dp is only compared with them"
          : IsKnown(second) ? ", and the speed is corrected"
                            : ", and the speed is left out";
  runs::ColumnSource agrees = (run.*pair.second).source;
  if (agrees.column.empty()) return text;
  agrees.scale /= second.factor;
  agrees.offset = (agrees.offset - second.offset) / second.factor;
  return text + ". This makes the two agree: " + LineOf(run, pair.second, agrees);
}

// Of a second sensor that balances do not use, what is wrong where it is not of the same quantity, or goes
// against it in a run that is too short to compare the two (`second`); else "".
std::string DoesNotFollow(const SensorPair& pair, const Run& run, const SensorBlocks& blocks,
                          const std::optional<SecondSensor>& second) {
  if (pair.set_aside) return "";
  const std::optional<double> correlation =
      CorrelationOfBlocks(blocks.first, blocks.second, kHardlyMoves * blocks.first_noise);
  const double least = second ? -kSameQuantity : -2;
  if (!correlation.has_value() || *correlation >= kSameQuantity || *correlation <= least) return "";
  const std::string& column = (run.*pair.second).source.column;
  return std::string(runs::RowOf(pair.second).ours) + " does not follow " + pair.what + " (correlation " +
         ShortNumber(*correlation, 2) + "): " + pair.believed + "; is " +
         (column.empty() ? "it" : "the column " + Quoted(column)) +
         (*correlation <= -kSameQuantity ? " of the other sign? Then turn that of its scale"
                                         : " another quantity?");
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
    const auto same = std::ranges::find_if(recorders, [&](const SameSensors& one) {
      const runs::ColumnSource& other = (runs[one.runs.front()].*pair.second).source;
      return other.column == source.column && other.scale == source.scale;
    });
    SameSensors& recorder = same == recorders.end() ? recorders.emplace_back() : *same;
    recorder.runs.push_back(r);
    AddSensorBlocks(pair, runs[r], &recorder.blocks);
  }
  return recorders;
}

// The values that were read `late` after each time, rounded to the nearest sample, so that values and their
// noise stay as recorded; NaN where the record has ended or not begun.
std::vector<double> Earlier(const std::vector<double>& time, const std::vector<double>& values, double late) {
  std::vector<double> moved(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (size_t k = 0; k < moved.size(); ++k) {
    const double at = time[k] + late;
    const auto after = std::ranges::upper_bound(time, at);
    if (after == time.begin() || after == time.end()) continue;
    const bool nearer = *after - at < at - *(after - 1);
    moved[k] = values[static_cast<size_t>(after - time.begin()) - (nearer ? 0 : 1)];
  }
  return moved;
}

}  // namespace

SensorsDiffer HowTheyDiffer(const SecondSensor& second, double size, double step) {
  if (std::abs(second.factor - 1) > kSensorFactor + second.factor_half) return SensorsDiffer::kInSize;
  if (std::abs(second.offset) > kSensorFactor * size + second.offset_half) return SensorsDiffer::kInSize;
  const bool late = std::abs(second.late) > std::max(kRecorderSamples * step, kSensorLate) + second.late_half;
  return late ? SensorsDiffer::kInTime : SensorsDiffer::kNot;
}

ComparedSensors CompareSensors(const std::vector<Run>& runs) {
  ComparedSensors compared;
  for (const SensorPair& pair : SensorPairs()) {
    for (const SameSensors& recorder : SensorsOf(pair, runs)) {
      std::vector<std::string> names;
      for (const size_t r : recorder.runs) names.push_back(runs[r].name);
      const Run& one_run = runs[recorder.runs.front()];
      const std::optional<SecondSensor> second = Compared(pair, recorder.blocks);
      const std::string other = DoesNotFollow(pair, one_run, recorder.blocks, second);
      if (!other.empty()) {
        compared.remarks.push_back(RunsNamed(names, runs.size()) + ": " + other);
        continue;
      }
      if (!second) continue;
      const double size = RootMeanSquare(recorder.blocks.first);
      const SensorsDiffer differ = HowTheyDiffer(*second, size, recorder.blocks.step);
      for (const size_t r : recorder.runs) {
        if (!pair.set_aside) continue;
        if (differ == SensorsDiffer::kInSize) {
          compared.unbelieved.push_back({r, pair.second, IsKnown(*second) ? second : std::nullopt});
        } else if (second->late != 0) {
          compared.unbelieved.push_back({r, pair.second, SecondSensor{.late = second->late}});
        }
      }
      if (differ == SensorsDiffer::kNot) continue;
      compared.remarks.push_back(RunsNamed(names, runs.size()) + ": " + Text(pair, one_run, *second, differ));
    }
  }
  return compared;
}

void CorrectOrLeaveOut(const std::vector<ComparedSensors::Unbelieved>& unbelieved,
                       const std::vector<Run*>& runs) {
  for (const ComparedSensors::Unbelieved& one : unbelieved) {
    runs::MeasuredSignal& signal = runs[one.run]->*one.signal;
    if (!one.reads) {
      signal.values.clear();
      continue;
    }
    for (double& value : signal.values) value = (value - one.reads->offset) / one.reads->factor;
    if (one.reads->late != 0) signal.values = Earlier(runs[one.run]->time, signal.values, one.reads->late);
    if (signal.noise) *signal.noise /= one.reads->factor;
  }
}

}  // namespace hydro::diagnose
