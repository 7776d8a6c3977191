#include "diagnose/data/alignment.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "base/word_list.h"
#include "diagnose/data/sample_interval.h"
#include "maths/solve.h"
#include "runs/run_delays.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFinestStep = 0.01;    // s: signals are averaged over this or a sample
constexpr double kLeastDelay = 0.02;    // s; a delay that is corrected reaches this
constexpr double kLeastSamples = 2;     // and this many steps
constexpr double kLongestDelay = 1.0;   // s; none exceeds this
constexpr double kLongestShare = 0.02;  // or this share of the run
constexpr double kUnbalanced = 0.1;     // largest share of a balance that correct delays leave open
constexpr double kMuchBetter = 0.5;     // most left open, relative to any shift of a single channel
constexpr double kMassive = 0.25;       // the same, relative to no shift
constexpr int kParts = 8;               // of a run, each estimated by itself
constexpr double kAgree = 0.2;          // parts agree within this share of the delay
constexpr double kAgreeSteps = 3;       // or this many steps
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Signals on an even grid, all smoothed a little in the same way, so that balances still hold.
struct Grid {
  double step = 0;  // s
  VectorXd voltage, speed, acceleration, p1, p2, p1_rate, p2_rate, arm_speed;
};

VectorXd Averaged(const std::vector<double>& time, const std::vector<double>& values, double step) {
  const double duration = time.back() - time.front();
  const auto cells = static_cast<Index>(std::floor(duration / step + 0.5)) + 1;
  VectorXd sum = VectorXd::Zero(cells), count = VectorXd::Zero(cells);
  for (size_t i = 0; i < time.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const auto cell = static_cast<Index>(std::floor((time[i] - time.front()) / step + 0.5));
    sum(cell) += values[i];
    count(cell) += 1;
  }
  // Fills a cell without a value by linear interpolation between its neighbours.
  Index before = -1;
  for (Index i = 0; i < cells; ++i) {
    if (count(i) == 0) continue;
    sum(i) /= count(i);
    for (Index k = before + 1; k < i; ++k) {
      const double share = before < 0 ? 1 : static_cast<double>(k - before) / static_cast<double>(i - before);
      sum(k) = before < 0 ? sum(i) : sum(before) + share * (sum(i) - sum(before));
    }
    before = i;
  }
  for (Index k = before + 1; k < cells; ++k) sum(k) = before < 0 ? kNone : sum(before);
  return sum;
}

VectorXd Smoothed(const VectorXd& values) {
  VectorXd smooth = values;
  for (Index i = 2; i + 2 < values.size(); ++i) {
    smooth(i) = (values(i - 2) + 4 * values(i - 1) + 6 * values(i) + 4 * values(i + 1) + values(i + 2)) / 16;
  }
  return smooth;
}

VectorXd Rate(const VectorXd& values, double step) {
  VectorXd rate = VectorXd::Zero(values.size());
  for (Index i = 1; i + 1 < values.size(); ++i) rate(i) = (values(i + 1) - values(i - 1)) / (2 * step);
  return rate;
}

std::vector<double> Speed(const runs::MeasuredSignal& speed, const runs::MeasuredSignal& angle,
                          const std::vector<double>& time) {
  if (speed.measured() || !angle.measured()) return speed.values;
  std::vector<double> rate(time.size(), kNone);
  for (size_t i = 1; i + 1 < time.size(); ++i) {
    rate[i] = (angle.values[i + 1] - angle.values[i - 1]) / (time[i + 1] - time[i - 1]);
  }
  return rate;
}

Grid MakeGrid(const runs::MeasuredRun& run, const model::Parameters& model) {
  Grid grid;
  grid.step = std::max(MedianInterval(run.time), kFinestStep);
  const auto even = [&](const std::vector<double>& values) {
    return Smoothed(Averaged(run.time, values, grid.step));
  };
  std::vector<double> torque = run.voltage.values;
  for (double& value : torque) value = std::clamp(model.k_1 * value, -model.T_pmax, model.T_pmax);
  grid.voltage = even(torque);
  grid.speed = even(Speed(run.motor_speed, run.motor_angle, run.time));
  grid.acceleration = Rate(grid.speed, grid.step);
  grid.p1 = even(run.p1.values);
  grid.p2 = even(run.p2.values);
  grid.p1_rate = Rate(grid.p1, grid.step);
  grid.p2_rate = Rate(grid.p2, grid.step);
  const std::vector<double> arm = Speed(run.arm_speed, run.arm_angle, run.time);
  if (run.shaft == model::Shaft::kDriven && !arm.empty()) grid.arm_speed = even(arm);
  return grid;
}

// What a linear balance leaves open: mean square over its target's variance; infinity where it cannot be
// told. `row` fills the regressors of a sample and returns its target, NaN for a sample that does not count.
template <int N, class Row>
double Open(Index first, Index last, const Row& row) {
  Eigen::Matrix<double, N + 1, N + 1> normal = Eigen::Matrix<double, N + 1, N + 1>::Zero();
  Eigen::Matrix<double, N + 1, 1> x;
  double sum = 0, count = 0;
  for (Index i = first; i < last; ++i) {
    x(N) = row(i, x.data());
    if (std::isnan(x(N))) continue;
    normal.template selfadjointView<Eigen::Lower>().rankUpdate(x);
    sum += x(N);
    count += 1;
  }
  constexpr double kInf = std::numeric_limits<double>::infinity();
  if (count < 20 * N) return kInf;
  const double yy = normal(N, N), variance = yy - sum * sum / count;
  if (!(variance > 0)) return kInf;
  Eigen::Matrix<double, N, N> inner = normal.template topLeftCorner<N, N>();
  const Eigen::Matrix<double, N, 1> right = normal.template bottomLeftCorner<1, N>().transpose();
  const Eigen::Matrix<double, N, 1> scale =
      inner.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  inner = scale.asDiagonal() * Eigen::Matrix<double, N, N>(inner.template selfadjointView<Eigen::Lower>()) *
          scale.asDiagonal();
  inner.diagonal().array() += 1e-10;
  const Eigen::Matrix<double, N, 1> scaled = scale.asDiagonal() * right;
  return std::max(0.0, yy - scaled.dot(maths::SolveSymmetric(inner, scaled).col(0))) / variance;
}

class Clocks {
 public:
  Clocks(Grid grid, const model::Parameters& model) : grid_(std::move(grid)), floor_(model.p_3) {
    const double duration = grid_.step * static_cast<double>(grid_.speed.size());
    reach_ = static_cast<int>(std::min(kLongestDelay, kLongestShare * duration) / grid_.step);
    slowest_ = 0.03 * grid_.speed.cwiseAbs().maxCoeff();
    lowest_ = floor_ + 0.05 * (std::max(grid_.p1.maxCoeff(), grid_.p2.maxCoeff()) - floor_);
  }

  int reach() const { return reach_; }
  Index begin() const { return reach_ + 2; }
  Index end() const { return grid_.speed.size() - reach_ - 2; }

  // What the torque balance leaves open with command and speed shifted by this many steps.
  double Torque(int command, int speed, Index first, Index last) const {
    return Open<6>(first, last, [&](Index i, double* x) {
      const double rate = grid_.speed(i + speed);
      if (std::abs(rate) < slowest_) return kNone;
      const double sign = rate > 0 ? 1 : -1;
      x[0] = grid_.p2(i) - grid_.p1(i);
      x[1] = grid_.acceleration(i + speed);
      x[2] = rate;
      x[3] = sign;
      x[4] = sign * (grid_.p1(i) + grid_.p2(i));
      x[5] = 1;
      return grid_.voltage(i + command);
    });
  }
  double Flow(int speed, int arm, Index first, Index last) const {
    return Open<5>(first, last, [&](Index i, double* x) {
      // Where both sides rest on their valves, the flows carry no information.
      if (grid_.p1(i) < lowest_ && grid_.p2(i) < lowest_) return kNone;
      x[0] = grid_.arm_speed(i + arm);
      x[1] = grid_.p1_rate(i);
      x[2] = grid_.p2_rate(i);
      x[3] = grid_.p2(i) - grid_.p1(i);
      x[4] = 1;
      return grid_.speed(i + speed);
    });
  }

 private:
  Grid grid_;
  double floor_;
  int reach_ = 0;
  double slowest_ = 0, lowest_ = 0;
};

// Delays of command and speed, steps.
using Pair = std::array<int, 2>;

Pair BestTorque(const Clocks& clocks, Index first, Index last) {
  Pair best = {0, 0};
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](int command, int speed) {
    if (std::max(std::abs(command), std::abs(speed)) > clocks.reach()) return;
    const double open = clocks.Torque(command, speed, first, last);
    if (!(open < least)) return;
    least = open;
    best = {command, speed};
  };
  // Try equal delays first: smooth signals have a single valley along that line.
  for (int both = -clocks.reach(); both <= clocks.reach(); both += 2) consider(both, both);
  for (Pair from = {clocks.reach() + 1, 0}; from != best;) {
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

Estimate Of(const std::vector<double>& parts, double whole) {
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

bool Suits(const runs::MeasuredRun& run) {
  return !run.bypass && run.p1.measured() && run.p2.measured() &&
         (run.motor_speed.measured() || run.motor_angle.measured()) && run.samples() >= 100;
}

// Where a part of the run begins and ends.
std::pair<Index, Index> Part(const Clocks& clocks, int part) {
  const Index first = clocks.begin(), length = clocks.end() - first;
  return {first + length * part / kParts, first + length * (part + 1) / kParts};
}

// Whether both are clearly late, and no shift of one of them alone comes near.
bool BothAreLate(const Clocks& clocks, const Pair& best, double least) {
  const int reach = clocks.reach();
  if (best[0] < least || best[1] < least || std::max(best[0], best[1]) >= reach) return false;
  const auto torque = [&](int command, int speed) {
    return clocks.Torque(command, speed, clocks.begin(), clocks.end());
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
Parts DelaysOfParts(const Clocks& clocks) {
  Parts parts;
  for (int part = 0; part < kParts; ++part) {
    const auto [from, to] = Part(clocks, part);
    const Pair here = BestTorque(clocks, from, to);
    const auto at = [&, from = from, to = to](int a, int b) {
      return clocks.Torque(here[0] + a, here[1] + b, from, to);
    };
    const double left = at(0, 0);
    if (!(left <= kUnbalanced)) continue;
    const bool inside = std::max(std::abs(here[0]), std::abs(here[1])) < clocks.reach();
    parts.command.push_back(here[0] + (inside ? Vertex(at(-1, 0), left, at(1, 0)) : 0));
    parts.speed.push_back(here[1] + (inside ? Vertex(at(0, -1), left, at(0, 1)) : 0));
  }
  return parts;
}

// The arm's delay in steps, with the motor's speed late by `speed`; nothing where too few parts of the run
// determine it.
std::optional<Estimate> DelayOfArm(const Clocks& clocks, int speed) {
  std::vector<double> parts;
  for (int part = 0; part < kParts; ++part) {
    const auto [from, to] = Part(clocks, part);
    const auto flow = [&, from = from, to = to](int arm) { return clocks.Flow(speed, arm, from, to); };
    const int arm = BestOf(clocks.reach() - 1, flow);
    if (flow(arm) <= kUnbalanced) parts.push_back(arm + Vertex(flow(arm - 1), flow(arm), flow(arm + 1)));
  }
  std::sort(parts.begin(), parts.end());
  if (parts.size() < kParts / 2) return std::nullopt;
  // All parts count equally: where a relief valve opens, the flows carry less information.
  const size_t half = parts.size() / 2;
  return Of(parts, parts.size() % 2 == 1 ? parts[half] : (parts[half - 1] + parts[half]) / 2);
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
  if (!Suits(*run)) return {};
  const Grid grid = MakeGrid(*run, model);
  for (const VectorXd* signal : {&grid.voltage, &grid.speed, &grid.p1, &grid.p2}) {
    if (!signal->allFinite()) return {};
  }
  const Clocks clocks(grid, model);
  const double least = std::max(kLeastSamples, kLeastDelay / grid.step);
  if (clocks.reach() <= least) return {};
  const Pair best = BestTorque(clocks, clocks.begin(), clocks.end());
  if (!BothAreLate(clocks, best, least)) return {};
  const Parts parts = DelaysOfParts(clocks);
  if (parts.command.size() < kParts / 2 || !Agree(parts.command, best[0]) || !Agree(parts.speed, best[1])) {
    return {};
  }
  const auto at = [&](int a, int b) {
    return clocks.Torque(best[0] + a, best[1] + b, clocks.begin(), clocks.end());
  };
  const double command = best[0] + Vertex(at(-1, 0), at(0, 0), at(1, 0));
  const double speed = best[1] + Vertex(at(0, -1), at(0, 0), at(0, 1));

  using Run = runs::MeasuredRun;
  std::vector<runs::SignalDelay> moves;
  std::vector<ClockDelay> delays = {
      DelayOf(*run, {{"voltage", &Run::voltage}, {"pressure_ref", &Run::pressure_ref}},
              Of(parts.command, command), grid.step, &moves),
      DelayOf(*run, {{"motor_speed", &Run::motor_speed}, {"motor_angle", &Run::motor_angle}},
              Of(parts.speed, speed), grid.step, &moves)};
  if (grid.arm_speed.size() > 0 && grid.arm_speed.allFinite()) {
    if (const std::optional<Estimate> arm = DelayOfArm(clocks, best[1])) {
      delays.push_back(DelayOf(*run, {{"arm_angle", &Run::arm_angle}, {"arm_speed", &Run::arm_speed}}, *arm,
                               grid.step, &moves));
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

std::string Says(const ClockDelay& delay) {
  char text[96];
  std::snprintf(text, sizeof text, "%s %s by %.3g +- %.2g s", delay.signals.size() > 1 ? "are" : "is",
                delay.delay < 0 ? "early" : "late", std::abs(delay.delay), delay.error);
  return RunNamed(delay.run) + ": " + Enumerated(delay.signals) + " " + text + " against p1 and p2";
}

}  // namespace hydro::diagnose
