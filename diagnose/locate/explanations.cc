#include "diagnose/locate/explanations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/number_text.h"

namespace hydro::diagnose {

namespace {

constexpr int kMostPeriods = 24;  // a turn

// The signal is smoothed, so its differences are as smooth as it is.
double RateOf(const std::vector<double>& values, const RunData& run, size_t k) {
  const size_t first = k == 0 ? 0 : k - 1, last = std::min(k + 1, values.size() - 1);
  return (values[last] - values[first]) / (run.stimulus.time[last] - run.stimulus.time[first]);
}

}  // namespace

template <class F>
Variable Explanations::Make(const std::string& name, const std::string& unit, const F& f, int arm) const {
  Variable variable{name, units_.UnitFor(unit, arm), {}, false, {}};
  for (size_t r = 0; r < runs_.size(); ++r) {
    std::vector<double> values(runs_[r]->samples());
    for (size_t k = 0; k < values.size(); ++k) values[k] = f(smoothed_[r], *runs_[r], k);
    variable.values.push_back(std::move(values));
  }
  return variable;
}

std::vector<Variable> Explanations::States(Balance balance, bool quick) const {
  using R = const SmoothedRun&;
  using D = const RunData&;
  const auto sign = [](double x) { return static_cast<double>((x > 0) - (x < 0)); };
  std::vector<Variable> all;  // plain ones first
  if (balance == Balance::kArmTorque) {
    all.push_back(Make(
        "arm_speed", "rad/s", [](R s, D, size_t k) { return s.arm_speed[k]; }, 1));
    all.push_back(Make(
        "arm_angle", "rad", [](R s, D, size_t k) { return s.arm_angle[k]; }, 1));
    all.push_back(Make("p2 - p1", "psi", [](R s, D, size_t k) { return s.p2[k] - s.p1[k]; }));
  } else {
    all.push_back(Make("motor_speed", "rad/s", [](R s, D, size_t k) { return s.motor_speed[k]; }));
    if (balance == Balance::kPumpTorque) {
      all.push_back(Make("p1 + p2", "psi", [](R s, D, size_t k) { return s.p1[k] + s.p2[k]; }));
      all.push_back(Make("(p1 + p2) sgn(motor_speed)", "psi",
                         [&](R s, D, size_t k) { return (s.p1[k] + s.p2[k]) * sign(s.motor_speed[k]); }));
      all.push_back(Make("motor_acceleration", "rad/s^2",
                         [](R s, D d, size_t k) { return RateOf(s.motor_speed, d, k); }));
    } else {
      const bool one = balance == Balance::kFlow1;
      all.push_back(
          Make(one ? "p1" : "p2", "psi", [one](R s, D, size_t k) { return one ? s.p1[k] : s.p2[k]; }));
      all.push_back(Make(one ? "p1 rate" : "p2 rate", "psi/s",
                         [one](R s, D d, size_t k) { return RateOf(one ? s.p1 : s.p2, d, k); }));
    }
    all.push_back(Make("p2 - p1", "psi", [](R s, D, size_t k) { return s.p2[k] - s.p1[k]; }));
    all.push_back(Make(
        "arm_angle", "rad", [](R s, D, size_t k) { return s.arm_angle[k]; }, 1));
    all.push_back(Make(
        "arm_speed", "rad/s", [](R s, D, size_t k) { return s.arm_speed[k]; }, 1));
  }
  if (quick && balance != Balance::kArmTorque) {
    for (int periods = 1; periods <= kMostPeriods; ++periods) all.push_back(Turn(periods));
    for (int periods = 1; periods <= kMostPeriods; ++periods) all.push_back(Ripple(balance, periods));
  }
  all.push_back(Make("time", "s", [](R, D d, size_t k) { return d.stimulus.time[k] - d.stimulus.begin; }));
  return all;
}

std::vector<Variable> Explanations::Commands() const {
  std::vector<Variable> all;
  all.push_back(Make("voltage", "V",
                     [](const SmoothedRun&, const RunData& d, size_t k) { return d.stimulus.voltage[k]; }));
  // A limit shows only beyond some voltage.
  double largest = 0;
  for (const RunData* run : runs_) {
    for (const double v : run->stimulus.voltage) largest = std::max(largest, std::abs(v));
  }
  for (const double part : {0.5, 0.65, 0.8, 0.9}) {
    const double from = part * largest;
    Variable beyond = Make("voltage", "V", [from](const SmoothedRun&, const RunData& d, size_t k) {
      const double v = d.stimulus.voltage[k];
      return v > from ? v - from : v < -from ? v + from : 0;
    });
    beyond.where = "|voltage| > " + ShortNumber(from, 3) + " V";
    beyond.name = "voltage beyond a limit";
    beyond.linear_only = true;
    all.push_back(std::move(beyond));
  }
  for (const double lag : {0.001, 0.002, 0.004, 0.008, 0.016, 0.032}) {
    double behind = 0;
    Variable change = Make("change of voltage", "V", [&](const SmoothedRun&, const RunData& d, size_t k) {
      const double now = d.stimulus.voltage[k];
      if (k == 0) {
        behind = now;
      } else {
        const double before = d.stimulus.voltage[k - 1];
        behind = before + (behind - before) * std::exp(-(d.stimulus.time[k] - d.stimulus.time[k - 1]) / lag);
      }
      return now - behind;
    });
    change.linear_only = true;
    all.push_back(std::move(change));
  }
  return all;
}

std::vector<Variable> Explanations::Lateness(Balance balance) const {
  std::vector<Variable> all;
  if (balance == Balance::kPumpTorque) {
    all.push_back(Make("p2 - p1 rate", "psi/s", [](const SmoothedRun& s, const RunData& d, size_t k) {
      return RateOf(s.p2, d, k) - RateOf(s.p1, d, k);
    }));
  } else if (balance != Balance::kArmTorque) {
    all.push_back(Make("motor_acceleration", "rad/s^2", [](const SmoothedRun& s, const RunData& d, size_t k) {
      return RateOf(s.motor_speed, d, k);
    }));
    all.push_back(Make(
        "arm_acceleration", "rad/s^2",
        [](const SmoothedRun& s, const RunData& d, size_t k) { return RateOf(s.arm_speed, d, k); }, 1));
  }
  for (Variable& variable : all) variable.linear_only = true;
  return all;
}

Variable Explanations::Turn(int periods) const {
  return Make("motor_angle, " + std::to_string(periods) + " periods a turn", "rad",
              [periods](const SmoothedRun& s, const RunData&, size_t k) {
                return std::remainder(periods * s.motor_angle[k], 2 * std::numbers::pi);
              });
}

Variable Explanations::Ripple(Balance balance, int periods) const {
  const bool torque = balance == Balance::kPumpTorque;
  Variable ripple = Make(torque ? "(p2 - p1)" : "motor_speed", torque ? "psi" : "rad/s",
                         [torque, periods](const SmoothedRun& s, const RunData&, size_t k) {
                           const double carrier = torque ? s.p2[k] - s.p1[k] : s.motor_speed[k];
                           return carrier * std::cos(periods * s.motor_angle[k]);
                         });
  ripple.name += " cos(" + std::to_string(periods) + " motor_angle)";
  ripple.linear_only = true;
  return ripple;
}

}  // namespace hydro::diagnose
