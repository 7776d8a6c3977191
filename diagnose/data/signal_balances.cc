#include "diagnose/data/signal_balances.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Run = runs::MeasuredRun;
using Rows = std::vector<std::vector<VectorXd>>;

constexpr double kFloor = 0.01;   // of the squared terms: no model is better known
constexpr size_t kSegments = 10;  // in a window, each overlapping half of the next
constexpr size_t kShortest = 3;   // samples of a segment
constexpr double kLow = 0.05;     // of a pressure's range: there a valve may be open, and no flow balances
constexpr size_t kFewestWindows = 3;
constexpr Index kFewestRows = 3;  // of a window

// A segment of a window, from a sample to another, with the integrals and differences of its signals.
struct Segment {
  const Run& window;
  size_t first, last;

  double Duration() const { return window.time[last] - window.time[first]; }
  double Difference(const runs::MeasuredSignal& signal) const {
    return signal.values[last] - signal.values[first];
  }
  template <class Value>
  double Integral(const Value& value) const {
    double sum = 0;
    for (size_t i = first; i < last; ++i) {
      sum += 0.5 * (value(i) + value(i + 1)) * (window.time[i + 1] - window.time[i]);
    }
    return sum;
  }
  double Integral(const runs::MeasuredSignal& signal) const {
    return Integral([&signal](size_t i) { return signal.values[i]; });
  }
  // Of the torque that the held command asks for, eq. (1).
  double Torque(const model::Parameters& model, double factor) const {
    double sum = 0;
    for (size_t i = first; i < last; ++i) {
      const double torque =
          std::clamp(model.k_1 * factor * window.voltage.values[i], -model.T_pmax, model.T_pmax);
      sum += torque * (window.time[i + 1] - window.time[i]);
    }
    return sum;
  }
};

template <class Row>
Rows RowsOf(const std::vector<Run>& windows, const Row& row) {
  Rows rows;
  for (const Run& window : windows) {
    rows.emplace_back();
    const size_t length = std::max(kShortest, window.samples() / kSegments);
    for (size_t first = 0; first + length < window.samples(); first += std::max<size_t>(1, length / 2)) {
      VectorXd terms = row(Segment{window, first, first + length});
      if (terms.size() > 0 && terms.allFinite()) rows.back().push_back(std::move(terms));
    }
  }
  return rows;
}

double MotorSpeed(const Run& window, size_t i) {
  if (window.motor_speed.measured()) return window.motor_speed.values[i];
  const size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, window.samples() - 1);
  return (window.motor_angle.values[after] - window.motor_angle.values[before]) /
         (window.time[after] - window.time[before]);
}

Rows RatesOfAngles(const std::vector<Run>& windows, const runs::MeasuredSignal Run::*angle,
                   const runs::MeasuredSignal Run::*speed) {
  return RowsOf(windows, [&](const Segment& segment) {
    return VectorXd{{segment.Difference(segment.window.*angle), segment.Integral(segment.window.*speed)}};
  });
}

// Inertia, oil of both columns, viscous and dry friction, and the command's torque at each factor.
Rows TorqueRows(const model::Parameters& model, const std::vector<Run>& windows, bool bypass, double slowest,
                const std::vector<double>& commands) {
  return RowsOf(windows, [&](const Segment& segment) {
    const Run& window = segment.window;
    const auto speed = [&window](size_t i) { return MotorSpeed(window, i); };
    VectorXd row(5 + static_cast<Index>(commands.size()));
    row(0) = model.J * (speed(segment.last) - speed(segment.first));
    row(1) = bypass ? 0 : model.D * segment.Integral(window.p1);
    row(2) = bypass ? 0 : model.D * segment.Integral(window.p2);
    row(3) = model.b * segment.Integral(speed);
    row(4) = model.T_s * segment.Integral([&](size_t i) { return std::tanh(speed(i) / slowest); });
    for (size_t c = 0; c < commands.size(); ++c) {
      row(5 + static_cast<Index>(c)) = segment.Torque(model, commands[c]);
    }
    return row;
  });
}

// Compression, that of the displaced volume, the pump's flow, the arm's, leakage out, p_3's part of it, and across.
Rows FlowRows(const model::Parameters& model, const Run& run, const std::vector<Run>& windows,
              runs::MeasuredSignal Run::*own, runs::MeasuredSignal Run::*other) {
  const ValueRange range = RangeOfValues((run.*own).values);
  const double low = range.low + kLow * range.size();
  const bool clamped = run.shaft == model::Shaft::kClamped;
  return RowsOf(windows, [&](const Segment& segment) -> VectorXd {
    const Run& window = segment.window;
    const double time = segment.Duration(), pressure = segment.Integral(window.*own);
    if (!(pressure / time > low)) return {};
    const double rise = segment.Difference(window.*own) / model.beta;
    const bool angle = !clamped && window.arm_angle.measured();
    const double arm = clamped ? run.arm_angle_rad : angle ? window.arm_angle.values[segment.first] : 0;
    const double moves = clamped ? 0
                         : angle ? segment.Difference(window.arm_angle)
                                 : segment.Integral(window.arm_speed);
    return VectorXd{{model.V_ms * rise, model.c * arm * rise,
                     model.D * segment.Integral([&window](size_t i) { return MotorSpeed(window, i); }),
                     model.c * moves, model.c_E * pressure, model.c_E * model.p_3 * time,
                     model.c_I * pressure,
                     (window.*other).measured() ? model.c_I * segment.Integral(window.*other) : 0.0}};
  });
}

}  // namespace

SignalFactors FactorsOf(const std::vector<RecordingMistake>& mistakes) {
  SignalFactors factors;
  const std::pair<SignalOfRun, double SignalFactors::*> members[] = {
      {&Run::voltage, &SignalFactors::voltage},
      {&Run::motor_speed, &SignalFactors::motor_speed},
      {&Run::motor_angle, &SignalFactors::motor_angle},
      {&Run::arm_angle, &SignalFactors::arm_angle},
      {&Run::arm_speed, &SignalFactors::arm_speed},
      {&Run::p1, &SignalFactors::p1},
      {&Run::p2, &SignalFactors::p2}};
  for (const RecordingMistake& mistake : mistakes) {
    factors.time *= mistake.time_factor;
    for (const auto& [signal, factor] : mistake.factors) {
      for (const auto& [of, member] : members) {
        if (of != signal) continue;
        // After an exchange the name means the other column.
        const bool other = factors.exchanged && (signal == &Run::p1 || signal == &Run::p2);
        const auto column = !other ? member : signal == &Run::p1 ? &SignalFactors::p2 : &SignalFactors::p1;
        factors.*column *= factor;
      }
    }
    factors.exchanged = factors.exchanged != mistake.pressures_exchanged;
  }
  return factors;
}

SignalBalances::SignalBalances(const model::Parameters& model, const Run& run,
                               const std::vector<Run>& windows,
                               const std::vector<RecordingMistake>& possible) {
  commands_ = {1};
  for (const RecordingMistake& mistake : possible) {
    const double size = std::abs(FactorsOf({mistake}).voltage);
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

SignalBalances::Balance SignalBalances::BalanceOf(const Rows& rows) {
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
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  return *middle;
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
