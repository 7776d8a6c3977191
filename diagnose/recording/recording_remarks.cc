#include "diagnose/recording/recording_remarks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/noise_remarks.h"
#include "diagnose/recording/sparse_columns.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

constexpr double kMostSaturated = 0.01;  // share of a signal's samples
constexpr double kMostMissing = 0.05;    // of a signal that is usually present
constexpr double kCoarseStep = 2;        // resolution, in standard deviations of the noise

std::string InPercent(double share) { return ShortNumber(100 * share, 3) + " %"; }

void RemarkOnTimes(const RunData& run, std::vector<std::string>* remarks) {
  const std::vector<double>& time = run.stimulus.time;
  const double usual = runs::MedianInterval(time);
  size_t gaps = 0, first = 0;
  double longest = 0;
  for (size_t i = 0; i + 1 < time.size(); ++i) {
    const double interval = time[i + 1] - time[i];
    if (interval <= kGapInTime * usual) continue;
    if (gaps++ == 0) first = i;
    longest = std::max(longest, interval);
  }
  if (gaps == 0) return;
  remarks->push_back(RunNamed(run.name) + ": " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
                     " in time, up to " + ShortNumber(longest, 3) + " s long, the first after " +
                     ShortNumber(time[first], 6) + " s");
}

void RemarkOnSignal(const RunData& run, const SignalData& signal, std::vector<std::string>* remarks) {
  const std::string name = RunNamed(run.name) + ": " + ChannelName(signal.channel);
  const std::string unit = " " + ChannelUnit(signal.channel, run.measured.units);
  const auto samples = static_cast<double>(run.samples());
  const auto there = static_cast<double>(signal.valid + signal.saturated);
  if (static_cast<double>(signal.saturated) > kMostSaturated * there) {
    remarks->push_back(name + " is at the end of its range in " +
                       InPercent(static_cast<double>(signal.saturated) / there) + " of its samples");
  }
  const double missing = 1 - there / samples;
  if (missing > kMostMissing && missing < kSlowerSensor) {
    remarks->push_back(name + " is missing in " + InPercent(missing) + " of the rows");
  }
  // In a recording without noise, the only noise is that of rounding, q / sqrt(12).
  if (signal.resolution > kCoarseStep * signal.noise && !std::isnan(signal.stated_noise)) {
    remarks->push_back(name + " is recorded in steps of " + ShortNumber(signal.resolution, 3) + unit +
                       ", coarser than its noise");
  }
}

// As a fraction of the motor's total path: less than this in the other direction is an overshoot.
constexpr double kOtherWay = 0.01;

// How far the motor turned each way, and whether it turned at all, from its angle where no speed was
// recorded.
struct MotorTurns {
  bool known = false;
  bool hardly = true;
  double forward = 0, backward = 0;  // sums of speeds, or of angles

  bool OneWay() const {
    return forward + backward > 0 && std::min(forward, backward) <= kOtherWay * std::max(forward, backward);
  }
};

void Add(const SignalData& signal, MotorTurns* turned) {
  const bool speed = signal.channel == model::Channel::kMotorSpeed;
  turned->known = true;
  turned->hardly = turned->hardly && maths::RangeOf(signal.values).size() < 2 * kHardlyMoves * signal.noise;
  // An angle counts once it has moved further than noise does.
  double from = speed ? 0 : std::numeric_limits<double>::quiet_NaN();
  for (const double value : signal.values) {
    if (std::isnan(value)) continue;
    if (std::isnan(from)) from = value;
    const double moved = value - from;
    if (!(std::abs(moved) > kHardlyMoves * signal.noise)) continue;
    (moved > 0 ? turned->forward : turned->backward) += std::abs(moved);
    if (!speed) from = value;
  }
}

// The fewest samples per time constant of the pump on the oil of both sides for which its motion shows.
constexpr double kFewestInMotion = 5;

// s, time constant of the pump's inertia on the stiffness of the oil at mid-stroke: eqs. (4), (13) and (14).
double PumpOnOil(const model::Parameters& model) {
  return std::sqrt(model.J * model.V_ms / (2 * model.beta)) / model.D;
}

void RemarkOnSlowSamples(const model::Parameters& model, const std::vector<const RunData*>& runs,
                         std::vector<std::string>* remarks) {
  const double fastest = PumpOnOil(model);
  std::vector<std::string> slow;
  double longest = 0;
  for (const RunData* run : runs) {
    const double interval = runs::MedianInterval(run->stimulus.time);
    if (run->stimulus.bypass || kFewestInMotion * interval <= fastest) continue;
    slow.push_back(run->name);
    longest = std::max(longest, interval);
  }
  if (slow.empty()) return;
  remarks->push_back(RunsNamed(slow) + ": samples " + ShortNumber(longest, 3) +
                     " s apart are too slow for the model's fastest motion, whose time constant is " +
                     ShortNumber(fastest, 2) + " s: what is as fast cannot be judged");
}

// Times what saturates the amplifier, eq. (1): controllers want more than they get, but hardly this much.
constexpr double kFarBeyond = 4;

void RemarkOnLargeCommands(const model::Parameters& model, const std::vector<const RunData*>& runs,
                           std::vector<std::string>* remarks) {
  const double saturates = model.T_pmax / model.k_1;
  for (const RunData* run : runs) {
    const maths::Range range = maths::RangeOf(run->stimulus.voltage);
    const double largest = std::max(-range.low, range.high);
    if (!(largest > kFarBeyond * saturates)) continue;
    const runs::SignalName& command = runs::kSignals.front();
    const std::string unit = " " + runs::UnitIn(run->measured, command);
    remarks->push_back(RunNamed(run->name) + ": " + runs::KeyIn(run->measured, command) + " reaches " +
                       ShortNumber(largest) + unit + ", " + ShortNumber(largest / saturates, 2) +
                       " times what saturates the amplifier, T_pmax/k_1 = " + ShortNumber(saturates) + unit +
                       ": is it in percent or counts, or as wanted before a limit?");
  }
}

void RemarkOnOneSide(const std::string& missing, const std::vector<std::string>& names, size_t runs,
                     std::vector<std::string>* remarks) {
  if (names.empty()) return;
  const std::string side = missing.substr(1);
  remarks->push_back(RunsNamed(names, runs) + ": " + missing +
                     " was not recorded: what leaks or opens on side " + side +
                     ", and how the sides differ, cannot be judged");
}

void RemarkOnMissingSignals(const std::vector<const RunData*>& runs, std::vector<std::string>* remarks) {
  bool motor = false, pressure = false, free = false, arm = false;
  std::vector<std::string> without_p1, without_p2;
  for (const RunData* run : runs) {
    free = free || run->stimulus.shaft == model::Shaft::kFree;
    motor = motor || run->measured.motor_speed.measured() || run->measured.motor_angle.measured();
    pressure = pressure || run->measured.p1.measured() || run->measured.p2.measured();
    const bool p1 = run->measured.p1.measured(), p2 = run->measured.p2.measured();
    if (p2 && !p1 && !run->stimulus.bypass) without_p1.push_back(run->name);
    if (p1 && !p2 && !run->stimulus.bypass) without_p2.push_back(run->name);
    arm = arm || run->measured.arm_angle.measured() || run->measured.arm_speed.measured();
  }
  if (!pressure) remarks->push_back("leakage and valves cannot be judged: no pressure was recorded");
  RemarkOnOneSide("p1", without_p1, runs.size(), remarks);
  RemarkOnOneSide("p2", without_p2, runs.size(), remarks);
  if (!motor) {
    remarks->push_back(
        "friction and inertia of the pump can hardly be judged: neither its speed nor its angle was "
        "recorded");
  }
  if (free && !arm)
    remarks->push_back("the arm cannot be judged: neither its angle nor its speed was recorded");
}

}  // namespace

std::vector<std::string> LayoutRemarks(const std::vector<const RunData*>& runs) {
  std::vector<std::string> remarks;
  std::vector<std::pair<std::string, std::string>> layouts;  // with their runs
  for (const RunData* run : runs) {
    const std::string& layout = run->measured.layout;
    if (layout.empty()) continue;
    const auto same = std::ranges::find_if(layouts, [&](const auto& one) { return one.first == layout; });
    if (same == layouts.end()) {
      layouts.emplace_back(layout, RunNamed(run->name));
    } else {
      same->second += ", " + RunNamed(run->name);
    }
  }
  remarks.reserve(layouts.size());
  for (const auto& [layout, names] : layouts) remarks.push_back(names + ": table read with " + layout);
  return remarks;
}

std::string LoadRemark(const std::vector<runs::MeasuredRun>& runs) {
  std::vector<std::string> names;
  for (const runs::MeasuredRun& run : runs) {
    if (run.in_an_arm && run.shaft == model::Shaft::kFree) names.push_back(run.name);
  }
  if (names.empty()) return "";
  return RunsNamed(names) +
         ": the load is that of the limb's [arm], in the place of J_a and mgl, and the model lacks it: what "
         "is found may stand for the arm";
}

std::vector<std::string> LimitRemarks(const model::Parameters& model,
                                      const std::vector<const RunData*>& runs) {
  std::vector<std::string> remarks;
  RemarkOnMissingSignals(runs, &remarks);
  RemarkOnSlowSamples(model, runs, &remarks);
  RemarkOnLargeCommands(model, runs, &remarks);
  return remarks;
}

void RequireMotion(const std::vector<const RunData*>& runs, const std::string& role) {
  if (runs.empty() || AreDriven(runs)) return;
  std::vector<std::string> names;
  for (const RunData* run : runs) {
    const bool moves = std::ranges::any_of(run->signals, [](const SignalData& signal) {
      return maths::RangeOf(signal.values).size() > 2 * kHardlyMoves * signal.noise;
    });
    if (moves) return;
    names.push_back(run->name);
  }
  throw InputError(RunsNamed(names) + ": found " + role +
                   " recordings in which nothing is commanded and nothing moves, allowed are such beside one "
                   "with motion: every model predicts rest, so nothing could be judged");
}

std::vector<std::string> MotionRemarks(const std::vector<const RunData*>& runs) {
  MotorTurns turned;
  double most_pressure = 0;
  bool pressure = false;
  std::vector<std::string> names;
  for (const RunData* run : runs) {
    const SignalData* speed = run->Find(model::Channel::kMotorSpeed);
    const SignalData* motion = speed != nullptr ? speed : run->Find(model::Channel::kMotorAngle);
    if (motion != nullptr) {
      Add(*motion, &turned);
      names.push_back(run->name);
    }
    for (const SignalData& signal : run->signals) {
      if (signal.channel != model::Channel::kP1 && signal.channel != model::Channel::kP2) continue;
      pressure = true;
      most_pressure = std::max(most_pressure, maths::RangeOf(signal.values).size() / signal.noise);
    }
  }
  std::vector<std::string> remarks;
  if (turned.known && turned.hardly) {
    remarks.push_back(RunsNamed(names, runs.size()) +
                      ": the motor hardly turns: friction and inertia cannot be identified");
  } else if (turned.OneWay()) {
    remarks.push_back(
        RunsNamed(names, runs.size()) +
        ": the motor turns one way only: friction, its asymmetry and a constant torque cannot be told apart");
  }
  if (pressure && most_pressure < 2 * kHardlyMoves) {
    remarks.push_back("the pressures hardly change in any run: fluid and leakage cannot be identified");
  }
  return remarks;
}

std::string DelayRemark(const ClockDelay& delay) {
  return RunNamed(delay.run) + ": " + Enumerated(delay.signals) +
         (delay.signals.size() > 1 ? " are " : " is ") + (delay.delay < 0 ? "early" : "late") + " by " +
         ShortNumber(std::abs(delay.delay), 3) + " +- " + ShortNumber(delay.error, 2) +
         " s relative to p1 and p2";
}

std::vector<std::string> RecordingRemarks(const std::vector<ClockDelay>& clocks,
                                          const std::vector<const RunData*>& runs,
                                          const std::vector<const RunData*>& held_out) {
  std::vector<std::string> remarks;
  remarks.reserve(clocks.size());
  for (const ClockDelay& clock : clocks) remarks.push_back(DelayRemark(clock));
  std::vector<const RunData*> all = runs;
  all.insert(all.end(), held_out.begin(), held_out.end());
  for (std::string& remark : NoiseRemarks(all)) remarks.push_back(std::move(remark));
  for (const RunData* run : all) {
    RemarkOnTimes(*run, &remarks);
    for (const SignalData& signal : run->signals) RemarkOnSignal(*run, signal, &remarks);
  }
  for (std::string& remark : MotionRemarks(runs)) remarks.push_back(std::move(remark));
  return remarks;
}

}  // namespace hydro::diagnose
