#include "diagnose/data/shifted_balances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "diagnose/data/sample_interval.h"
#include "maths/solve.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kFinestStep = 0.01;    // s: signals are averaged over this or a sample
constexpr double kLongestDelay = 1.0;   // s; none exceeds this
constexpr double kLongestShare = 0.02;  // or this share of the run

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
  for (Index k = before + 1; k < cells; ++k) sum(k) = before < 0 ? runs::kMissing : sum(before);
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
  std::vector<double> rate(time.size(), runs::kMissing);
  for (size_t i = 1; i + 1 < time.size(); ++i) {
    rate[i] = (angle.values[i + 1] - angle.values[i - 1]) / (time[i + 1] - time[i - 1]);
  }
  return rate;
}

// What a linear balance leaves open: mean square over its target's variance; infinity where it cannot be
// told. `row` fills the regressors of a sample and returns its target, NaN for a sample that does not count.
template <int N, class Row>
double ShareLeftOpen(Index first, Index last, const Row& row) {
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

}  // namespace

EvenSignals MakeEven(const runs::MeasuredRun& run, const model::Parameters& model) {
  EvenSignals even;
  even.step = std::max(MedianInterval(run.time), kFinestStep);
  const auto smooth = [&](const std::vector<double>& values) {
    return Smoothed(Averaged(run.time, values, even.step));
  };
  std::vector<double> torque = run.voltage.values;
  for (double& value : torque) value = std::clamp(model.k_1 * value, -model.T_pmax, model.T_pmax);
  even.voltage = smooth(torque);
  even.speed = smooth(Speed(run.motor_speed, run.motor_angle, run.time));
  even.acceleration = Rate(even.speed, even.step);
  even.p1 = smooth(run.p1.values);
  even.p2 = smooth(run.p2.values);
  even.p1_rate = Rate(even.p1, even.step);
  even.p2_rate = Rate(even.p2, even.step);
  const std::vector<double> arm = Speed(run.arm_speed, run.arm_angle, run.time);
  if (run.shaft == model::Shaft::kDriven && !arm.empty()) even.arm_speed = smooth(arm);
  return even;
}

ShiftedBalances::ShiftedBalances(EvenSignals signals, const model::Parameters& model)
    : signals_(std::move(signals)), floor_(model.p_3) {
  const double duration = signals_.step * static_cast<double>(signals_.speed.size());
  reach_ = static_cast<int>(std::min(kLongestDelay, kLongestShare * duration) / signals_.step);
  slowest_ = 0.03 * signals_.speed.cwiseAbs().maxCoeff();
  lowest_ = floor_ + 0.05 * (std::max(signals_.p1.maxCoeff(), signals_.p2.maxCoeff()) - floor_);
}

double ShiftedBalances::Torque(int command, int speed, Index first, Index last) const {
  return ShareLeftOpen<6>(first, last, [&](Index i, double* x) {
    const double rate = signals_.speed(i + speed);
    if (std::abs(rate) < slowest_) return runs::kMissing;
    const double sign = rate > 0 ? 1 : -1;
    x[0] = signals_.p2(i) - signals_.p1(i);
    x[1] = signals_.acceleration(i + speed);
    x[2] = rate;
    x[3] = sign;
    x[4] = sign * (signals_.p1(i) + signals_.p2(i));
    x[5] = 1;
    return signals_.voltage(i + command);
  });
}

double ShiftedBalances::Flow(int speed, int arm, Index first, Index last) const {
  return ShareLeftOpen<5>(first, last, [&](Index i, double* x) {
    // Where both sides rest on their valves, the flows carry no information.
    if (signals_.p1(i) < lowest_ && signals_.p2(i) < lowest_) return runs::kMissing;
    x[0] = signals_.arm_speed(i + arm);
    x[1] = signals_.p1_rate(i);
    x[2] = signals_.p2_rate(i);
    x[3] = signals_.p2(i) - signals_.p1(i);
    x[4] = 1;
    return signals_.speed(i + speed);
  });
}

}  // namespace hydro::diagnose
