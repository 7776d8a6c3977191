#include "diagnose/balances/run_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/maths/spread.h"
#include "diagnose/recording/second_sensors.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using std::numbers::sqrt2;

// The Gaussian's reach, in standard deviations.
constexpr double kReach = 4;
// The arm's direction is certain once it has moved by this part of its range since it turned, or by more than
// noise hides.
constexpr double kTurnPart = 1e-3;

constexpr model::Channel kChannelOf[kGridChannels] = {model::Channel::kMotorSpeed,
                                                      model::Channel::kMotorAngle, model::Channel::kArmAngle,
                                                      model::Channel::kP1, model::Channel::kP2};

std::vector<double> KernelOf(double sigma) {
  const int reach = std::max(1, static_cast<int>(std::ceil(kReach * sigma)));
  std::vector<double> kernel;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(std::exp(-0.5 * std::pow(i / sigma, 2)));
    sum += kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

double RootSum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

// The signal's values at the grid's times: straight lines between its samples.
GridSignal OnGrid(const RunData& run, size_t which, double step, size_t count) {
  GridSignal grid;
  const runs::MeasuredSignal& measured = run.measured.*kSignalOf[which];
  if (!measured.measured()) return grid;
  const SignalData* prepared = run.Find(kChannelOf[which]);
  const std::vector<double>& values = prepared != nullptr ? prepared->values : measured.values;
  const std::vector<double>& time = run.stimulus.time;
  std::vector<double> own_time, own;
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    own_time.push_back(time[i]);
    own.push_back(values[i]);
  }
  if (own.size() < 4) return grid;
  grid.interval = std::max(step, runs::MedianInterval({&own_time}));
  grid.noise = measured.noise.value_or(EstimateNoise(own));
  const maths::Range range = maths::RangeOf(own);
  grid.noise = std::max(grid.noise, 1e-9 * range.size() + 1e-300);
  grid.values.resize(count);
  grid.gap.assign(count, 0);
  size_t next = 0;
  for (size_t k = 0; k < count; ++k) {
    const double t = time.front() + static_cast<double>(k) * step;
    while (next < own.size() && own_time[next] < t - 1e-6 * step) ++next;
    if (next == 0 || next == own.size()) {
      grid.values[k] = next == 0 ? own.front() : own.back();
      grid.gap[k] = std::abs(t - (next == 0 ? own_time.front() : own_time.back())) > grid.interval ? 1 : 0;
      continue;
    }
    const double width = own_time[next] - own_time[next - 1];
    const double part = std::min(1.0, (t - own_time[next - 1]) / width);
    grid.values[k] = own[next - 1] + part * (own[next] - own[next - 1]);
    grid.gap[k] = width > 2.5 * grid.interval ? 1 : 0;
  }
  return grid;
}

// The mean of the command from each instant of the grid to the next. A row's command acts until the next row,
// whose time is seldom quite the grid's: clocks run 20 millionths fast, and times since 1970 are rounded.
std::vector<double> HeldOnGrid(const RunData& run, double step, size_t count) {
  constexpr double kSameInstant = 1e-6;  // of a step
  std::vector<double> held(count);
  const std::vector<double>& time = run.stimulus.time;
  size_t row = 0;
  for (size_t k = 0; k < count; ++k) {
    const double end = time.front() + static_cast<double>(k + 1) * step;
    double from = time.front() + static_cast<double>(k) * step, held_for = 0;
    for (; from < end - kSameInstant * step; ++row) {
      const double until = row + 1 < time.size() ? std::min(time[row + 1], end) : end;
      if (until > from + kSameInstant * step) {
        held_for += until - from;
        held[k] += (run.stimulus.voltage[row] - held[k]) * ((until - from) / held_for);
        from = until;
      }
      if (until == end) break;
    }
  }
  return held;
}

std::vector<model::Surroundings> AroundOnGrid(const model::Stimulus& run, double step, size_t count) {
  std::vector<model::Surroundings> around(run.around.empty() ? 0 : count);
  size_t next = 1;
  for (size_t k = 0; k < around.size(); ++k) {
    const double t = run.time.front() + static_cast<double>(k) * step;
    while (next + 1 < run.time.size() && run.time[next] < t) ++next;
    const double part =
        std::clamp((t - run.time[next - 1]) / (run.time[next] - run.time[next - 1]), 0.0, 1.0);
    for (double model::Surroundings::*one :
         {&model::Surroundings::arm_force, &model::Surroundings::temperature}) {
      const double before = run.around[next - 1].*one;
      around[k].*one = before + part * (run.around[next].*one - before);
    }
  }
  return around;
}

// The arm's direction; where the arm stands, the last one.
std::vector<double> Directions(const std::vector<double>& angle, double noise) {
  const maths::Range range = maths::RangeOf(angle);
  const double reach = std::max({kTurnPart * range.size(), kHides * noise, 1e-300});
  std::vector<double> direction(angle.size());
  double bent = 0;
  for (size_t i = 0; i < angle.size(); ++i) {
    const double moved = i == 0 ? 0 : (angle[i] - angle[i - 1]) / reach;
    bent += moved * (1 - bent * (moved > 0 ? 1 : moved < 0 ? -1 : 0));
    bent = std::clamp(bent, -1.0, 1.0);
    direction[i] = bent;
  }
  return direction;
}

const std::vector<double>& SmoothedOf(const GridSignal& signal, double sigma, std::vector<double>* store) {
  *store = Smoothed(signal.values, sigma);
  return *store;
}

// The single pressure of a run whose two sides are connected, or of a run without measured pressures.
double OnePressure(const RunMotion& run, const model::Parameters& given, size_t k) {
  double sum = 0;
  int count = 0;
  for (const GridChannel side : {GridChannel::kP1, GridChannel::kP2}) {
    if (!run.Of(side).measured()) continue;
    sum += run.Of(side).values[k];
    ++count;
  }
  return count > 0 ? sum / count : given.p_3;
}

// Sets the pressures that were measured.
void SetPressures(double sigma, RunMotion* run) {
  for (const GridChannel side : {GridChannel::kP1, GridChannel::kP2}) {
    if (!run->Of(side).measured()) continue;
    const bool first = side == GridChannel::kP1;
    const std::vector<double> smooth = Smoothed(run->Of(side).values, sigma);
    const std::vector<double> rate = Derivative(smooth, run->step);
    for (size_t k = 0; k < run->size(); ++k) {
      (first ? run->at[k].p1 : run->at[k].p2) = smooth[k];
      (first ? run->at[k].p1_rate : run->at[k].p2_rate) = rate[k];
    }
  }
}

// Sets the outside influences, smoothed as all signals are.
void SetAround(double sigma, RunMotion* run) {
  if (run->around.empty()) return;
  std::vector<double> force;
  force.reserve(run->size());
  for (const model::Surroundings& one : run->around) force.push_back(one.arm_force);
  force = Smoothed(force, sigma);
  for (size_t k = 0; k < run->size(); ++k) run->at[k].around = {force[k], run->around[k].temperature};
}

// Fills `at` from the signals.
void SetMotion(const model::Parameters& given, double begin, RunMotion* run) {
  const size_t n = run->voltage.size();
  const double sigma = SmoothingOf(run->step) / run->step;
  run->at.assign(n, {});
  for (size_t k = 0; k < n; ++k) {
    run->at[k].time = begin + static_cast<double>(k) * run->step;
    run->at[k].voltage = run->voltage[k];
  }
  SetAround(sigma, run);
  const auto set = [&](double model::KnownMotion::*place, const std::vector<double>& values) {
    for (size_t k = 0; k < n; ++k) run->at[k].*place = values[k];
  };
  const GridSignal& speed = run->Of(GridChannel::kSpeed);
  const GridSignal& angle = run->Of(GridChannel::kAngle);
  std::vector<double> smooth, w;
  const std::vector<double> kernel = KernelOf(sigma);
  if (run->from_angle) {
    w = Derivative(SmoothedOf(angle, sigma, &smooth), run->step);
    run->speed_noise = angle.noise * RootSum(Derivative(kernel, run->step));
  } else if (speed.measured()) {
    w = SmoothedOf(speed, sigma, &smooth);
    run->speed_noise = speed.noise * RootSum(kernel);
  }
  if (!w.empty()) {
    set(&model::KnownMotion::motor_speed, w);
    set(&model::KnownMotion::motor_acceleration, Derivative(w, run->step));
    for (model::KnownMotion& at : run->at)
      at.pump_direction = std::erf(at.motor_speed / (sqrt2 * std::max(run->speed_noise, 1e-300)));
    if (angle.measured()) {
      set(&model::KnownMotion::motor_angle, SmoothedOf(angle, sigma, &smooth));
    } else {
      for (size_t k = 1; k < n; ++k)
        run->at[k].motor_angle = run->at[k - 1].motor_angle + 0.5 * (w[k] + w[k - 1]) * run->step;
    }
  }
  const GridSignal& arm = run->Of(GridChannel::kArm);
  for (model::KnownMotion& at : run->at) at.arm_angle = run->options.arm_angle;
  if (run->arm_moves) {
    set(&model::KnownMotion::arm_angle, SmoothedOf(arm, sigma, &smooth));
    set(&model::KnownMotion::arm_speed, Derivative(smooth, run->step));
    set(&model::KnownMotion::arm_acceleration, Derivative(Derivative(smooth, run->step), run->step));
    set(&model::KnownMotion::arm_direction, Directions(smooth, arm.noise * RootSum(kernel)));
  }
  if (run->pressures) {
    SetPressures(sigma, run);
  } else {
    for (size_t k = 0; k < n; ++k) run->at[k].p1 = run->at[k].p2 = OnePressure(*run, given, k);
    if (!run->options.bypass) SetPressures(sigma, run);
  }
}

// Whether the speed contradicts the angle in this run (second_sensors.h says it, of all runs together). The
// angle is then used alone, because it is counted, whereas a recorded speed has passed through a filter.
bool SpeedContradictsAngle(const RunMotion& run) {
  constexpr double kSurely = 5;  // standard errors
  const double sigma = SmoothingOf(run.step) / run.step;
  const std::vector<double> speed = Smoothed(run.Of(GridChannel::kSpeed).values, sigma);
  const std::vector<double> turned =
      Derivative(Smoothed(run.Of(GridChannel::kAngle).values, sigma), run.step);
  const std::vector<double> rate = Derivative(turned, run.step);
  // speed = factor turned - late rate
  double tt = 0, tr = 0, rr = 0, ts = 0, rs = 0, ss = 0;
  for (size_t k = 0; k < speed.size(); ++k) {
    tt += turned[k] * turned[k];
    tr += turned[k] * rate[k];
    rr += rate[k] * rate[k];
    ts += turned[k] * speed[k];
    rs += rate[k] * speed[k];
    ss += speed[k] * speed[k];
  }
  const double determinant = tt * rr - tr * tr;
  if (!(determinant > 1e-6 * tt * rr)) return false;
  SecondSensor second;
  second.factor = (ts * rr - rs * tr) / determinant;
  second.late = -(rs * tt - ts * tr) / determinant;
  // Noise must not decide.
  const double left = std::max(0.0, ss - second.factor * ts + second.late * rs);
  const double error = kSurely * std::sqrt(left / static_cast<double>(speed.size()));
  second.factor_half = error / std::sqrt(tt);
  second.late_half = error / std::sqrt(rr);
  return HowTheyDiffer(second, 0, run.step) != SensorsDiffer::kNot;
}

}  // namespace

double SmoothingOf(double step) { return std::max(kSmoothing, 0.7 * step); }

std::vector<double> Derivative(const std::vector<double>& values, double step) {
  constexpr double kWeight[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  // Beyond its ends the series continues point-symmetrically about the end points.
  const auto value = [&](std::ptrdiff_t i) {
    if (i < 0) return 2 * values.front() - values[static_cast<size_t>(std::min(n - 1, -i))];
    if (i >= n)
      return 2 * values.back() - values[static_cast<size_t>(std::max<std::ptrdiff_t>(0, 2 * (n - 1) - i))];
    return values[static_cast<size_t>(i)];
  };
  std::vector<double> rate(values.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::ptrdiff_t lag = 1; lag <= 3; ++lag) sum += kWeight[lag - 1] * (value(i + lag) - value(i - lag));
    rate[static_cast<size_t>(i)] = sum / step;
  }
  return rate;
}

std::vector<double> Smoothed(const std::vector<double>& values, double sigma) {
  const std::vector<double> kernel = KernelOf(sigma);
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto reach = static_cast<std::ptrdiff_t>(kernel.size() / 2);
  std::vector<double> padded(static_cast<size_t>(n + 2 * reach));
  for (std::ptrdiff_t i = -reach; i < n + reach; ++i) {
    const std::ptrdiff_t mirrored = i < 0 ? -i : i >= n ? 2 * (n - 1) - i : i;
    padded[static_cast<size_t>(i + reach)] =
        values[static_cast<size_t>(std::clamp<std::ptrdiff_t>(mirrored, 0, n - 1))];
  }
  std::vector<double> smooth(values.size(), 0.0);
  for (size_t k = 0; k < kernel.size(); ++k) {
    const double weight = kernel[k];
    const double* from = padded.data() + k;
    for (size_t i = 0; i < smooth.size(); ++i) smooth[i] += weight * from[i];
  }
  return smooth;
}

RunMotion MotionOf(const RunData& run, const model::Parameters& given, const ReadAs& as) {
  RunMotion motion;
  motion.name = run.name;
  motion.options.shaft = run.stimulus.shaft;
  // If the force that drives the arm is known, the arm's balance is that of a free arm.
  if (run.stimulus.shaft == model::Shaft::kDriven && run.measured.arm_force.measured())
    motion.options.shaft = model::Shaft::kFree;
  motion.options.bypass = run.stimulus.bypass;
  motion.options.arm_angle = run.stimulus.arm_angle;
  motion.options.begin = run.stimulus.begin;
  motion.options.motion = run.stimulus.motion;
  const std::vector<double>& time = run.stimulus.time;
  motion.interval = runs::MedianInterval({&time});
  motion.step = static_cast<double>(as.every) * motion.interval;
  const auto count =
      static_cast<size_t>(std::floor((time.back() - time.front()) / motion.step * (1 + 1e-9))) + 1;
  motion.stride =
      std::max<size_t>(1, static_cast<size_t>(std::floor(kBalanceStep / motion.step * (1 + 1e-9))));
  motion.voltage = HeldOnGrid(run, motion.step, count);
  motion.around = AroundOnGrid(run.stimulus, motion.step, count);
  for (size_t s = 0; s < kGridChannels; ++s) {
    motion.signals[s] = OnGrid(run, s, motion.step, count);
    motion.signals[s].noise = std::max(motion.signals[s].noise, as.least_noise[s]);
  }
  for (size_t s = 0; s < kGridChannels; ++s) {
    if (std::ranges::find(as.inverted, ChannelName(kChannelOf[s])) == as.inverted.end()) continue;
    for (double& value : motion.signals[s].values) value = -value;
  }
  motion.pressures = !run.stimulus.bypass && motion.Of(GridChannel::kP1).measured() &&
                     motion.Of(GridChannel::kP2).measured();
  motion.arm_moves = run.stimulus.shaft != model::Shaft::kClamped && motion.Of(GridChannel::kArm).measured();
  motion.from_angle = !motion.Of(GridChannel::kSpeed).measured();
  motion.speed_known = motion.Of(GridChannel::kSpeed).measured() || motion.Of(GridChannel::kAngle).measured();
  motion.from_angle = motion.from_angle && motion.speed_known;
  if (!motion.from_angle && motion.Of(GridChannel::kAngle).measured())
    motion.from_angle = SpeedContradictsAngle(motion);
  SetMotion(given, time.front(), &motion);
  return motion;
}

RunMotion WithNoiseAgain(const RunMotion& run, const model::Parameters& given, uint64_t seed) {
  RunMotion noisy = run;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (GridSignal& signal : noisy.signals) {
    if (!signal.measured()) continue;
    const auto every = std::max<size_t>(1, static_cast<size_t>(std::lround(signal.interval / run.step)));
    double before = signal.noise * normal(random);
    // Noise of a signal that is slower than the grid also follows straight lines.
    for (size_t k = 0; k < signal.values.size(); k += every) {
      const double after = signal.noise * normal(random);
      for (size_t i = k; i < std::min(k + every, signal.values.size()); ++i) {
        const double part = static_cast<double>(i - k) / static_cast<double>(every);
        signal.values[i] += before + part * (after - before);
      }
      before = after;
    }
  }
  SetMotion(given, run.at.front().time, &noisy);
  // The quantities that decide where a term acts stay as they were: only the terms themselves are compared.
  for (size_t k = 0; k < run.size(); ++k) {
    noisy.at[k].motor_angle = run.at[k].motor_angle;
    if (run.IsLatent(GridChannel::kP1)) {
      noisy.at[k].p1 = run.at[k].p1;
      noisy.at[k].p1_rate = run.at[k].p1_rate;
    }
    if (run.IsLatent(GridChannel::kP2)) {
      noisy.at[k].p2 = run.at[k].p2;
      noisy.at[k].p2_rate = run.at[k].p2_rate;
    }
    noisy.at[k].pump_direction =
        std::erf(noisy.at[k].motor_speed / (sqrt2 * std::max(run.speed_noise, 1e-300)));
  }
  return noisy;
}

RunMotion Without(const RunMotion& run, const SignalErrors& errors, double part) {
  RunMotion moved = run;
  const auto take = [&](const std::vector<double>& of, double model::KnownMotion::*place) {
    for (size_t k = 0; k < moved.size(); ++k) moved.at[k].*place -= part * of[k];
  };
  const auto& [speed, angle, arm, p1, p2] = errors.of;
  const std::vector<double> w = run.from_angle && !angle.empty() ? Derivative(angle, run.step)
                                : run.from_angle                 ? std::vector<double>{}
                                                                 : speed;
  if (!w.empty()) {
    take(w, &model::KnownMotion::motor_speed);
    take(Derivative(w, run.step), &model::KnownMotion::motor_acceleration);
  }
  if (!angle.empty()) take(angle, &model::KnownMotion::motor_angle);
  if (run.arm_moves && !arm.empty()) {
    const std::vector<double> rate = Derivative(arm, run.step);
    take(arm, &model::KnownMotion::arm_angle);
    take(rate, &model::KnownMotion::arm_speed);
    take(Derivative(rate, run.step), &model::KnownMotion::arm_acceleration);
  }
  if (run.pressures && !run.IsLatent(GridChannel::kP1) && !p1.empty()) {
    take(p1, &model::KnownMotion::p1);
    take(Derivative(p1, run.step), &model::KnownMotion::p1_rate);
  }
  if (run.pressures && !run.IsLatent(GridChannel::kP2) && !p2.empty()) {
    take(p2, &model::KnownMotion::p2);
    take(Derivative(p2, run.step), &model::KnownMotion::p2_rate);
  }
  return moved;
}

}  // namespace hydro::diagnose
