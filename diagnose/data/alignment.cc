#include "diagnose/data/alignment.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/data/shifted_balances.h"
#include "runs/run_delays.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLeastDelay = 0.02;  // s; a delay that is corrected reaches this
constexpr double kLeastSamples = 2;   // and this many steps
constexpr double kUnbalanced = 0.1;   // largest share of a balance that correct delays leave open
constexpr double kMuchBetter = 0.5;   // most left open, relative to any shift of a single channel
constexpr double kMassive = 0.25;     // the same, relative to no shift
constexpr int kParts = 8;             // of a run, each estimated by itself
constexpr double kAgree = 0.2;        // parts agree within this share of the delay
constexpr double kAgreeSteps = 3;     // or this many steps

// Delays of command and speed, steps.
using Pair = std::array<int, 2>;

Pair BestTorque(const ShiftedBalances& balances, Index first, Index last) {
  Pair best = {0, 0};
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](int command, int speed) {
    if (std::max(std::abs(command), std::abs(speed)) > balances.reach()) return;
    const double open = balances.Torque(command, speed, first, last);
    if (!(open < least)) return;
    least = open;
    best = {command, speed};
  };
  // Try equal delays first: smooth signals have a single valley along that line.
  for (int both = -balances.reach(); both <= balances.reach(); both += 2) consider(both, both);
  for (Pair from = {balances.reach() + 1, 0}; from != best;) {
    from = best;
    for (int a = -3; a <= 3; ++a) {
      for (int b = -3; b <= 3; ++b) consider(from[0] + a, from[1] + b);
    }
  }
  return best;
}

int BestOf(int reach, const std::function<double(int)>& open) {
  int best = 0;
  for (int shift = -reach; shift <= reach; ++shift) {
    if (open(shift) < open(best)) best = shift;
  }
  return best;
}

// Where the parabola through three equally spaced values has its minimum, relative to the middle one.
double Vertex(double before, double here, double after) {
  const double bend = before - 2 * here + after;
  return bend > 0 ? std::clamp((before - after) / (2 * bend), -0.5, 0.5) : 0;
}

struct Estimate {
  double mean = 0, error = 0;
};

Estimate EstimateOf(const std::vector<double>& parts, double whole) {
  double square = 0;
  for (const double part : parts) square += (part - whole) * (part - whole);
  const auto n = static_cast<double>(parts.size());
  return {whole, 2 * std::sqrt(square / (n * std::max(1.0, n - 1)))};
}

bool Agree(const std::vector<double>& parts, double whole) {
  return std::all_of(parts.begin(), parts.end(), [&](double part) {
    return std::abs(part - whole) <= std::max(kAgreeSteps, kAgree * std::abs(whole));
  });
}

bool CanBeAligned(const runs::MeasuredRun& run) {
  return !run.bypass && run.p1.measured() && run.p2.measured() &&
         (run.motor_speed.measured() || run.motor_angle.measured()) && run.samples() >= 100;
}

// Where a part of the run begins and ends.
std::pair<Index, Index> Part(const ShiftedBalances& balances, int part) {
  const Index first = balances.begin(), length = balances.end() - first;
  return {first + length * part / kParts, first + length * (part + 1) / kParts};
}

// Whether both are clearly late, and no shift of one of them alone comes near.
bool BothAreLate(const ShiftedBalances& balances, const Pair& best, double least) {
  const int reach = balances.reach();
  if (best[0] < least || best[1] < least || std::max(best[0], best[1]) >= reach) return false;
  const auto torque = [&](int command, int speed) {
    return balances.Torque(command, speed, balances.begin(), balances.end());
  };
  const double open = torque(best[0], best[1]);
  if (open > kUnbalanced || open > kMassive * torque(0, 0)) return false;
  for (int one = -reach; one <= reach; ++one) {
    if (open > kMuchBetter * std::min(torque(one, 0), torque(0, one))) return false;
  }
  return true;
}

// Delays in steps, one for each part of the run.
struct Parts {
  std::vector<double> command, speed;
};

// Estimates each part of the run by itself, as long as it has motion.
Parts DelaysOfParts(const ShiftedBalances& balances) {
  Parts parts;
  for (int part = 0; part < kParts; ++part) {
    const auto [from, to] = Part(balances, part);
    const Pair here = BestTorque(balances, from, to);
    const auto at = [&, from = from, to = to](int a, int b) {
      return balances.Torque(here[0] + a, here[1] + b, from, to);
    };
    const double left = at(0, 0);
    if (!(left <= kUnbalanced)) continue;
    const bool inside = std::max(std::abs(here[0]), std::abs(here[1])) < balances.reach();
    parts.command.push_back(here[0] + (inside ? Vertex(at(-1, 0), left, at(1, 0)) : 0));
    parts.speed.push_back(here[1] + (inside ? Vertex(at(0, -1), left, at(0, 1)) : 0));
  }
  return parts;
}

// The arm's delay in steps, with the motor's speed late by `speed`; nothing where too few parts of the run
// determine it.
std::optional<Estimate> DelayOfArm(const ShiftedBalances& balances, int speed) {
  std::vector<double> parts;
  for (int part = 0; part < kParts; ++part) {
    const auto [from, to] = Part(balances, part);
    const auto flow = [&, from = from, to = to](int arm) { return balances.Flow(speed, arm, from, to); };
    const int arm = BestOf(balances.reach() - 1, flow);
    if (flow(arm) <= kUnbalanced) parts.push_back(arm + Vertex(flow(arm - 1), flow(arm), flow(arm + 1)));
  }
  std::sort(parts.begin(), parts.end());
  if (parts.size() < kParts / 2) return std::nullopt;
  // All parts count equally: where a relief valve opens, the flows carry less information.
  const size_t half = parts.size() / 2;
  return EstimateOf(parts, parts.size() % 2 == 1 ? parts[half] : (parts[half - 1] + parts[half]) / 2);
}

// The signals recorded by one clock, by name.
using Signals = std::vector<std::pair<const char*, runs::MeasuredSignal runs::MeasuredRun::*>>;

ClockDelay DelayOf(const runs::MeasuredRun& run, const Signals& signals, const Estimate& steps, double step,
                   std::vector<runs::SignalDelay>* moves) {
  ClockDelay delay{run.name, {}, step * steps.mean, step * std::hypot(steps.error, 0.5)};
  for (const auto& [name, signal] : signals) {
    if (!(run.*signal).measured()) continue;
    delay.signals.emplace_back(name);
    moves->emplace_back(signal, delay.delay);
  }
  return delay;
}

}  // namespace

std::vector<ClockDelay> AlignClocks(const model::Parameters& model, runs::MeasuredRun* run) {
  if (!CanBeAligned(*run)) return {};
  const EvenSignals even = MakeEven(*run, model);
  for (const VectorXd* signal : {&even.voltage, &even.speed, &even.p1, &even.p2}) {
    if (!signal->allFinite()) return {};
  }
  const ShiftedBalances balances(even, model);
  const double least = std::max(kLeastSamples, kLeastDelay / even.step);
  if (balances.reach() <= least) return {};
  const Pair best = BestTorque(balances, balances.begin(), balances.end());
  if (!BothAreLate(balances, best, least)) return {};
  const Parts parts = DelaysOfParts(balances);
  if (parts.command.size() < kParts / 2 || !Agree(parts.command, best[0]) || !Agree(parts.speed, best[1])) {
    return {};
  }
  const auto at = [&](int a, int b) {
    return balances.Torque(best[0] + a, best[1] + b, balances.begin(), balances.end());
  };
  const double command = best[0] + Vertex(at(-1, 0), at(0, 0), at(1, 0));
  const double speed = best[1] + Vertex(at(0, -1), at(0, 0), at(0, 1));

  using Run = runs::MeasuredRun;
  std::vector<runs::SignalDelay> moves;
  std::vector<ClockDelay> delays = {
      DelayOf(*run, {{"voltage", &Run::voltage}, {"pressure_ref", &Run::pressure_ref}},
              EstimateOf(parts.command, command), even.step, &moves),
      DelayOf(*run, {{"motor_speed", &Run::motor_speed}, {"motor_angle", &Run::motor_angle}},
              EstimateOf(parts.speed, speed), even.step, &moves)};
  if (even.arm_speed.size() > 0 && even.arm_speed.allFinite()) {
    if (const std::optional<Estimate> arm = DelayOfArm(balances, best[1])) {
      delays.push_back(DelayOf(*run, {{"arm_angle", &Run::arm_angle}, {"arm_speed", &Run::arm_speed}}, *arm,
                               even.step, &moves));
    }
  }
  if (!runs::RemoveDelays(moves, run)) return {};
  return delays;
}

RunData PrepareAligned(runs::MeasuredRun run, const model::Parameters& model,
                       std::vector<ClockDelay>* delays) {
  runs::MeasuredRun recorded = run;
  const std::vector<ClockDelay> found = AlignClocks(model, &run);
  if (found.empty()) return PrepareRun(std::move(run), model);
  PrepareRun(std::move(recorded), model);  // errors then name the rows of the recording
  RunData data = PrepareRun(std::move(run), model);
  double error = 0;
  for (const ClockDelay& delay : found) {
    if (delay.signals.front().starts_with("arm")) continue;  // imposed: not compared
    error = std::max(error, delay.error / 2);
  }
  for (SignalData& signal : data.signals) {
    double square = 0, count = 0;
    for (size_t i = 1; i < data.samples(); ++i) {
      const double step = data.stimulus.time[i] - data.stimulus.time[i - 1];
      const double rate = (signal.values[i] - signal.values[i - 1]) / step;
      if (std::isnan(rate)) continue;
      // Less the contribution of noise.
      square += rate * rate - 2 * signal.noise * signal.noise / (step * step);
      count += 1;
    }
    if (count > 0 && square > 0) signal.noise = std::hypot(signal.noise, error * std::sqrt(square / count));
  }
  delays->insert(delays->end(), found.begin(), found.end());
  return data;
}

std::string DelayRemark(const ClockDelay& delay) {
  return RunNamed(delay.run) + ": " + Enumerated(delay.signals) +
         (delay.signals.size() > 1 ? " are " : " is ") + (delay.delay < 0 ? "early" : "late") + " by " +
         ShortNumber(std::abs(delay.delay), 3) + " +- " + ShortNumber(delay.error, 2) +
         " s relative to p1 and p2";
}

}  // namespace hydro::diagnose
