#include "diagnose/evidence/clocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "base/maths/spread.h"
#include "base/parallel.h"
#include "diagnose/evidence/late_signals.h"
#include "diagnose/recording/run_data.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Signal = runs::MeasuredSignal Run::*;

// Pressures that hardly leave their noise are no clock to hold the others against. White noise alone spans
// nine of its standard deviations in a long run, so that as much again is motion.
bool Changes(const runs::MeasuredSignal& signal) {
  const double noise = signal.noise.value_or(EstimateNoise(signal.values));
  return maths::RangeOf(signal.values).size() > 4 * kHardlyMoves * noise;
}

bool CanBeAligned(const Run& run) {
  return !run.bypass && run.p1.measured() && run.p2.measured() && Changes(run.p1) && Changes(run.p2) &&
         (run.motor_speed.measured() || run.motor_angle.measured()) && run.samples() >= 2 * kFewestSamples &&
         run.time.back() - run.time.front() >= kClockTile &&
         runs::MedianInterval(run.time) <= runs::kSlowestSamples;
}

// The signals of a device, by name.
const std::vector<std::pair<const char*, Signal>>& SignalsOf(Late late) {
  static const std::vector<std::pair<const char*, Signal>> kOf[] = {
      {{"voltage", &Run::voltage}, {"pressure_ref", &Run::pressure_ref}},
      {{"motor_speed", &Run::motor_speed}, {"motor_angle", &Run::motor_angle}},
      {{"arm_angle", &Run::arm_angle}, {"arm_speed", &Run::arm_speed}}};
  return kOf[static_cast<size_t>(late)];
}

double LeastDelay(const Run& run) {
  return std::max(kLeastDelay, kRecorderSamples * runs::MedianInterval(run.time));
}

// Whether command and motor are late enough to belong to another clock.
bool AreLate(const LateSignals& found, const Run& run) {
  const double least = LeastDelay(run);
  return found.delay[0] >= least && found.delay[1] >= least &&
         std::max(found.delay[0], found.delay[1]) < LargestDelay(run);
}

// Delays that the catalogue can name: of a single signal, or of both pressures.
const std::vector<std::vector<Late>> kOthers = {
    {Late::kCommand}, {Late::kMotor}, {Late::kPressures, Late::kP2}};

// Shifts the run's signals.
std::vector<ClockDelay> Moved(const LateSignals& found, const std::vector<Late>& late, Run* run) {
  const double half_a_sample = 0.5 * runs::MedianInterval(run->time);
  std::vector<ClockDelay> clocks;
  Delays delays{};
  for (size_t i = 0; i < late.size(); ++i) {
    ClockDelay clock{run->name, {}, found.delay[i], std::hypot(2 * found.error[i], half_a_sample)};
    for (const auto& [name, signal] : SignalsOf(late[i])) {
      if ((run->*signal).measured()) clock.signals.emplace_back(name);
    }
    delays[static_cast<size_t>(late[i])] = clock.delay;
    clocks.push_back(std::move(clock));
  }
  if (!runs::RemoveDelays(OfSignals(delays), run)) return {};
  return clocks;
}

}  // namespace

std::vector<ClockDelay> AlignClocks(const model::ModelDescription& given, Run* run) {
  if (!CanBeAligned(*run)) return {};
  std::vector<Late> late = {Late::kCommand, Late::kMotor};
  LateSignals devices;
  try {
    devices = FindLate(given, *run, late);
    if (!AreLate(devices, *run)) return {};
    double others = FindLate(given, *run, {}).score;
    for (const std::vector<Late>& other : kOthers)
      others = std::max(others, FindLate(given, *run, other).score);
    if (run->shaft != model::Shaft::kClamped && run->arm_angle.measured()) {
      const LateSignals with_arm = FindLate(given, *run, {Late::kCommand, Late::kMotor, Late::kArm});
      const bool another = std::abs(with_arm.delay[2]) >= LeastDelay(*run);
      if (AreLate(with_arm, *run) && another && with_arm.score > devices.score) {
        devices = with_arm;
        late.push_back(Late::kArm);
      }
    }
    if (devices.score <= others) return {};
  } catch (const InputError&) {
    return {};  // reported for the run itself, where it is prepared
  } catch (const model::ModelError&) {
    return {};
  }
  return Moved(devices, late, run);
}

std::vector<AlignedRun> AlignedRuns(const model::ModelDescription& given, const std::vector<Run>& runs,
                                    int jobs) {
  std::vector<AlignedRun> aligned(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    aligned[r].run = runs[r];
    aligned[r].clocks = AlignClocks(given, &aligned[r].run);
  });
  return aligned;
}

RunData PrepareAligned(const Run& recorded, AlignedRun aligned, const model::ModelDescription& given,
                       std::vector<ClockDelay>* delays) {
  const std::vector<ClockDelay>& found = aligned.clocks;
  if (!found.empty()) PrepareRun(recorded, given);  // so that errors name the rows of the recording
  RunData data = PrepareRun(std::move(aligned.run), given);
  if (found.empty()) return data;
  double error = 0;
  for (const ClockDelay& delay : found) {
    if (delay.signals.front().starts_with("arm")) continue;  // the arm's motion is imposed, not compared
    error = std::max(error, delay.error / 2);
  }
  for (SignalData& signal : data.signals) {
    double square = 0, count = 0;
    for (size_t i = 1; i < data.samples(); ++i) {
      const double step = data.stimulus.time[i] - data.stimulus.time[i - 1];
      const double rate = (signal.values[i] - signal.values[i - 1]) / step;
      if (std::isnan(rate)) continue;
      // Without the contribution of noise.
      square += rate * rate - 2 * signal.noise * signal.noise / (step * step);
      count += 1;
    }
    if (count > 0 && square > 0) signal.noise = std::hypot(signal.noise, error * std::sqrt(square / count));
  }
  delays->insert(delays->end(), found.begin(), found.end());
  return data;
}

}  // namespace hydro::diagnose
