#include "gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "loops.h"

namespace foreign_rig {

namespace {

constexpr double kRate = 500;  // Hz, of comparison
const int kStepsATick = static_cast<int>(std::lround(1 / (kRate * kStep)));
constexpr int kEvery = 2;  // of this many windows one is compared
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A start that is off by a noise unit and shows less than this over its window (a pressure that a valve sets
// right at once) explains nothing: it would have to be off by a hundred.
constexpr double kSeen = 0.01;

// A difference quotient is no better than this: what is less after the others are taken off is its own error.
constexpr double kLeast = 1e-3;

constexpr double kValueStep = 1e-3;  // part by which values are changed
constexpr double kMostOff = 2;       // of its uncertainty: as far as DrawGiven() has a value off

constexpr double kRateTime = 0.1;      // s in which an arm's angle tells its rate
constexpr double kShaftShift = 0.001;  // rad, small against any period of a pump or motor

// One after the other.
Series Joined(const std::vector<Series>& parts) {
  Series all;
  for (const Series& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Series Difference(Series a, const Series& b) {
  for (size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

GapMeter::GapMeter(std::vector<Plan> plans, const std::array<double, kChannels>& noise, double seconds)
    : plans_(std::move(plans)), noise_(noise), seconds_(seconds) {}

void GapMeter::Append(const Reading& a, const Reading& b, const Plan& plan, Series* to) const {
  to->push_back((a.speed - b.speed) / noise_[kSpeed]);
  to->push_back((a.p1 - b.p1) / noise_[kSide1]);
  to->push_back((a.p2 - b.p2) / noise_[kSide2]);
  if (!plan.day.clamped) to->push_back((a.arm - b.arm) / noise_[kArmAngle]);
}

// A noise unit of the sensor that shows it.
double GapMeter::ShiftOf(Machine::Start start) const {
  switch (start) {
    case Machine::Start::kSpeed:
      return noise_[kSpeed];
    case Machine::Start::kPressure1:
      return noise_[kSide1];
    case Machine::Start::kPressure2:
      return noise_[kSide2];
    case Machine::Start::kArm:
      return noise_[kArmAngle];
    case Machine::Start::kArmRate:
      return noise_[kArmAngle] / kRateTime;
    case Machine::Start::kShaft:
      return kShaftShift;
  }
  return 0;
}

// The rig with everything runs through the plan with its loops; the others follow its commands from its
// states.
void GapMeter::AddWindows(const Rig& with, const std::vector<Rig>& others, bool other_starts,
                          const Plan& plan, std::vector<Window>* windows) const {
  Machine whole(with, plan.day);
  std::vector<Machine> lacking;
  for (const Rig& other : others) lacking.emplace_back(other, plan.day);
  std::vector<Machine::Start> starts;
  if (other_starts) starts = lacking[0].FreeStarts();
  std::vector<Machine> shifted(starts.size(), lacking[0]);
  Loops loops(plan, with.values, kRate);
  const int ticks_a_window = static_cast<int>(std::lround(kWindow * kRate));
  const int ticks = static_cast<int>(seconds_ * kRate);
  for (int k = -static_cast<int>(plan.day.prelude * kRate); k < ticks; ++k) {
    const bool compares = k >= 0 && k / ticks_a_window % kEvery == 0;
    if (compares && k % ticks_a_window == 0) {
      windows->push_back({std::vector<Series>(lacking.size()), std::vector<Series>(shifted.size())});
      for (Machine& machine : lacking) machine.ContinueFrom(whole);
      for (size_t i = 0; i < shifted.size(); ++i) {
        shifted[i] = lacking[0];
        shifted[i].Shift(starts[i], ShiftOf(starts[i]));
      }
    }
    const double volts = loops.Volts(k / kRate, whole.Read());
    for (int i = 0; i < kStepsATick; ++i) whole.Step(volts);
    if (!compares) continue;
    const auto follow = [&](std::vector<Machine>& machines, std::vector<Series>& differences) {
      for (size_t m = 0; m < machines.size(); ++m) {
        for (int i = 0; i < kStepsATick; ++i) machines[m].Step(volts);
        Append(whole.Read(), machines[m].Read(), plan, &differences[m]);
      }
    };
    follow(lacking, windows->back().rigs);
    follow(shifted, windows->back().starts);
  }
}

std::vector<GapMeter::Window> GapMeter::Windows(const Rig& with, const std::vector<Rig>& others,
                                                bool other_starts) const {
  std::vector<Window> windows;
  for (const Plan& plan : plans_) AddWindows(with, others, other_starts, plan, &windows);
  return windows;
}

double GapMeter::Between(const Rig& with, const Rig& without) const {
  try {
    std::vector<Series> parts;
    for (Window& window : Windows(with, {without}, false)) parts.push_back(std::move(window.rigs[0]));
    return RootMeanSquare(Joined(parts));
  } catch (const std::runtime_error&) {
    return kInfinite;
  }
}

// Starts belong to a window: taken off there first, of the gap and of what other values do to it; then what
// values within their limits do, over all windows.
GapMeter::Parts GapMeter::Beyond(const Rig& with, const Rig& without) const {
  std::vector<Rig> others = {without};
  std::vector<double> limits;
  for (const ValueForm& form : ValueForms()) {
    // Friction by pressure is an effect where the model has none.
    if (without.values.*form.value == 0) continue;
    others.push_back(without);
    others.back().values.*form.value *= 1 + kValueStep;
    limits.push_back(kMostOff * form.uncertainty / kValueStep);
  }
  std::vector<Window> windows;
  try {
    windows = Windows(with, others, true);
  } catch (const std::runtime_error&) {
    return {kInfinite, kInfinite};
  }
  std::vector<Series> whole, rest;
  std::vector<std::vector<Series>> values(limits.size());  // by window
  for (const Window& window : windows) {
    Directions starts;
    for (const Series& start : window.starts) {
      const Series direction = Difference(start, window.rigs[0]);
      starts.Add(direction, std::max(kSeen, kLeast * RootMeanSquare(direction)));
    }
    whole.push_back(window.rigs[0]);
    rest.push_back(window.rigs[0]);
    starts.TakeOff(&rest.back());
    for (size_t v = 0; v < values.size(); ++v) {
      values[v].push_back(Difference(window.rigs[v + 1], window.rigs[0]));
      starts.TakeOff(&values[v].back());
    }
  }
  std::vector<Series> columns;
  for (const std::vector<Series>& value : values) columns.push_back(Joined(value));
  Series left = Joined(rest);
  TakeOffWithin(columns, limits, &left);
  return {RootMeanSquare(Joined(whole)), RootMeanSquare(left)};
}

}  // namespace foreign_rig
