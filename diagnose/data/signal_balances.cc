#include "diagnose/data/signal_balances.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/data/balance_rows.h"
#include "diagnose/data/run_data.h"
#include "maths/median.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Run = runs::MeasuredRun;

constexpr double kFloor = 0.01;  // of the squared terms: no model is better known
constexpr size_t kFewestWindows = 3;
constexpr Index kFewestRows = 3;  // of a window

}  // namespace

void AddFactors(const RecordingMistake& mistake, SignalFactors* factors) {
  static constexpr std::pair<SignalOfRun, double SignalFactors::*> kMembers[] = {
      {&Run::voltage, &SignalFactors::voltage},
      {&Run::motor_speed, &SignalFactors::motor_speed},
      {&Run::motor_angle, &SignalFactors::motor_angle},
      {&Run::arm_angle, &SignalFactors::arm_angle},
      {&Run::arm_speed, &SignalFactors::arm_speed},
      {&Run::p1, &SignalFactors::p1},
      {&Run::p2, &SignalFactors::p2}};
  factors->time *= mistake.time_factor;
  for (const auto& [signal, factor] : mistake.factors) {
    for (const auto& [of, member] : kMembers) {
      if (of != signal) continue;
      // After an exchange the name means the other column.
      const bool other = factors->exchanged && (signal == &Run::p1 || signal == &Run::p2);
      const auto column = !other ? member : signal == &Run::p1 ? &SignalFactors::p2 : &SignalFactors::p1;
      factors->*column *= factor;
    }
  }
  factors->exchanged = factors->exchanged != mistake.pressures_exchanged;
}

SignalBalances::SignalBalances(const model::Parameters& model, const Run& run,
                               const std::vector<Run>& windows,
                               const std::vector<RecordingMistake>& possible) {
  commands_ = {1};
  for (const RecordingMistake& mistake : possible) {
    SignalFactors factors;
    AddFactors(mistake, &factors);
    const double size = std::abs(factors.voltage);
    if (std::find(commands_.begin(), commands_.end(), size) == commands_.end()) commands_.push_back(size);
  }
  clamped_ = run.shaft == model::Shaft::kClamped;
  angle_only_ = !run.motor_speed.measured();
  arm_speed_only_ = !run.arm_angle.measured();
  if (run.motor_speed.measured() && run.motor_angle.measured()) {
    motor_ = BalanceOf(RatesOfAngles(windows, &Run::motor_angle, &Run::motor_speed));
  }
  if (run.arm_speed.measured() && run.arm_angle.measured() && !clamped_) {
    arm_ = BalanceOf(RatesOfAngles(windows, &Run::arm_angle, &Run::arm_speed));
  }
  if (angle_only_ && !run.motor_angle.measured()) return;
  const double slowest =
      std::max(1e-9, 3 * EstimateNoise((angle_only_ ? run.motor_angle : run.motor_speed).values));
  if (run.bypass || (run.p1.measured() && run.p2.measured())) {
    torque_ = BalanceOf(TorqueRows(model, windows, run.bypass, slowest, commands_));
  }
  flow_ = !run.bypass && (clamped_ || run.arm_angle.measured() || run.arm_speed.measured());
  if (flow_ && run.p1.measured()) flows_[0] = BalanceOf(FlowRows(model, run, windows, &Run::p1, &Run::p2));
  if (flow_ && run.p2.measured()) flows_[1] = BalanceOf(FlowRows(model, run, windows, &Run::p2, &Run::p1));
}

SignalBalances::Balance SignalBalances::BalanceOf(const BalanceRows& rows) {
  Balance balance;
  Index all = 0;
  for (const auto& window : rows) {
    if (std::cmp_less(window.size(), kFewestRows)) continue;
    balance.first.push_back(all);
    all += static_cast<Index>(window.size());
  }
  if (balance.first.size() < kFewestWindows) return {};
  balance.first.push_back(all);
  for (const auto& window : rows) {
    if (std::cmp_less(window.size(), kFewestRows)) continue;
    if (balance.terms.rows() == 0) balance.terms.resize(0, window.front().size());
    for (const VectorXd& row : window) {
      balance.terms.conservativeResize(balance.terms.rows() + 1, Eigen::NoChange);
      balance.terms.bottomRows(1) = row.transpose();
    }
  }
  const auto windows = static_cast<Index>(balance.first.size()) - 1;
  balance.squares.resize(windows, balance.terms.cols());
  for (Index w = 0; w < windows; ++w) {
    const Index first = balance.first[static_cast<size_t>(w)],
                last = balance.first[static_cast<size_t>(w) + 1];
    balance.squares.row(w) = balance.terms.middleRows(first, last - first).colwise().squaredNorm();
  }
  return balance;
}

double SignalBalances::Balance::LeftOpen(const VectorXd& coefficients) const {
  if (first.empty()) return 0;
  const VectorXd open = terms * coefficients;
  const VectorXd whole = squares * coefficients.cwiseAbs2();
  std::vector<double> shares;
  for (size_t w = 0; w + 1 < first.size(); ++w) {
    const double left = open.segment(first[w], first[w + 1] - first[w]).squaredNorm();
    const double of = whole(static_cast<Index>(w));
    if (of > 0) shares.push_back(std::log(std::max(kFloor, left / of)));
  }
  if (shares.empty()) return 0;
  return maths::Median(shares);
}

double SignalBalances::TorqueLeftOpen(const SignalFactors& f) const {
  if (torque_.first.empty()) return 0;
  VectorXd coefficients = VectorXd::Zero(torque_.terms.cols());
  // An angle's rate falls as the times grow.
  const double speed = angle_only_ ? f.motor_angle / f.time : f.motor_speed;
  const double dp = f.exchanged ? -1 : 1;
  coefficients.head<5>() << speed, -dp * f.p1 * f.time, dp * f.p2 * f.time, speed * f.time,
      std::copysign(f.time, speed);
  const auto command = std::find(commands_.begin(), commands_.end(), std::abs(f.voltage));
  coefficients(5 + (command - commands_.begin())) = -std::copysign(f.time, f.voltage);
  return torque_.LeftOpen(coefficients);
}

// Of the side that the column is of: 0 with the column p1, unless they are exchanged.
double SignalBalances::FlowLeftOpen(const SignalFactors& f, int column) const {
  const Balance& balance = flows_[column];
  if (balance.first.empty()) return 0;
  const double speed = angle_only_ ? f.motor_angle / f.time : f.motor_speed;
  const double own = column == 0 ? f.p1 : f.p2, other = column == 0 ? f.p2 : f.p1;
  const double side = (column == 0) != f.exchanged ? 1 : -1;
  const double arm = clamped_ ? 1 : arm_speed_only_ ? f.arm_speed * f.time : f.arm_angle;
  VectorXd coefficients(8);
  coefficients << own, -side * own * arm, side * speed * f.time, -side * arm, own * f.time, -f.time,
      own * f.time, -other * f.time;
  return balance.LeftOpen(coefficients);
}

double SignalBalances::LeftOpen(const SignalFactors& f) const {
  return motor_.LeftOpen(Eigen::Vector2d{f.motor_angle, -f.motor_speed * f.time}) +
         arm_.LeftOpen(Eigen::Vector2d{f.arm_angle, -f.arm_speed * f.time}) + TorqueLeftOpen(f) +
         FlowLeftOpen(f, 0) + FlowLeftOpen(f, 1);
}

}  // namespace hydro::diagnose
