#include "diagnose/data/balance_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Run = runs::MeasuredRun;

constexpr size_t kSegments = 10;  // in a window, each overlapping half of the next
constexpr size_t kShortest = 3;   // samples of a segment
constexpr double kLow = 0.05;     // of a pressure's range: there a valve may be open, and no flow balances

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
BalanceRows RowsOf(const std::vector<Run>& windows, const Row& row) {
  BalanceRows rows;
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

}  // namespace

BalanceRows RatesOfAngles(const std::vector<Run>& windows, const runs::MeasuredSignal Run::*angle,
                          const runs::MeasuredSignal Run::*speed) {
  return RowsOf(windows, [&](const Segment& segment) {
    return VectorXd{{segment.Difference(segment.window.*angle), segment.Integral(segment.window.*speed)}};
  });
}

BalanceRows TorqueRows(const model::Parameters& model, const std::vector<Run>& windows, bool bypass,
                       double slowest, const std::vector<double>& commands) {
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

BalanceRows FlowRows(const model::Parameters& model, const Run& run, const std::vector<Run>& windows,
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

}  // namespace hydro::diagnose
