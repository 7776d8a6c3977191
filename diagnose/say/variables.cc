#include "diagnose/say/variables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/number_text.h"

namespace hydro::diagnose {

namespace {

using Known = model::KnownMotion;
using std::numbers::pi;

constexpr int kMostTurnPeriods = 24;  // a turn

// `unit` is the paper's, `arm` the power of the arm's coordinate in it.
struct VariableOfMotion {
  const char* name;
  const char* unit;
  std::function<double(const Known&)> of;
  int arm = 0;
  bool only_names = false, rate = false;
};

Variable Along(const std::vector<LackingRun>& runs, const UnitSystem& units, const VariableOfMotion& what) {
  Variable variable{what.name, units.UnitFor(what.unit, what.arm), {}, what.only_names, {}, what.only_names};
  for (const LackingRun& run : runs) {
    std::vector<double> values(run.size());
    for (size_t i = 0; i < values.size(); ++i) values[i] = what.of(run.At(i));
    variable.values.push_back(std::move(values));
  }
  return variable;
}

std::vector<VariableOfMotion> ArmVariables() {
  return {{"arm_speed", "rad/s", [](const Known& at) { return at.arm_speed; }, 1},
          {"arm_angle", "rad", [](const Known& at) { return at.arm_angle; }, 1},
          {"p2 - p1", "psi", [](const Known& at) { return at.p2 - at.p1; }, 0, true}};
}

// In the order of their simplicity.
std::vector<VariableOfMotion> PlainVariables(BalanceKind balance) {
  std::vector<VariableOfMotion> arm = ArmVariables();
  if (balance == BalanceKind::kArm) return arm;
  std::vector<VariableOfMotion> all = {
      {"motor_speed", "rad/s", [](const Known& at) { return at.motor_speed; }}};
  if (balance == BalanceKind::kTorque) {
    all.push_back({"p1 + p2", "psi", [](const Known& at) { return at.p1 + at.p2; }});
    all.push_back({"(p1 + p2) sgn(motor_speed)", "psi",
                   [](const Known& at) { return std::copysign(at.p1 + at.p2, at.motor_speed); }});
    all.push_back({"motor_acceleration", "rad/s^2", [](const Known& at) { return at.motor_acceleration; }, 0,
                   true, true});
  } else if (balance == BalanceKind::kFlow1) {
    all.push_back({"p1", "psi", [](const Known& at) { return at.p1; }});
    all.push_back({"p1 rate", "psi/s", [](const Known& at) { return at.p1_rate; }, 0, true, true});
  } else {
    all.push_back({"p2", "psi", [](const Known& at) { return at.p2; }});
    all.push_back({"p2 rate", "psi/s", [](const Known& at) { return at.p2_rate; }, 0, true, true});
  }
  std::reverse(arm.begin(), arm.end());
  all.insert(all.end(), arm.begin(), arm.end());
  return all;
}

// The phase of a wave that repeats so often in a turn of the motor, and such a wave in proportion to the speed or the
// pressure difference.
void AddTurns(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units,
              std::vector<Variable>* all) {
  for (int n = 1; n <= kMostTurnPeriods; ++n) {
    all->push_back(Along(runs, units, {"", "rad", [n](const Known& at) {
                                         return std::remainder(n * at.motor_angle, 2 * pi);
                                       }}));
    all->back().name = "motor_angle, " + std::to_string(n) + " periods a turn";
  }
  const bool torque = balance == BalanceKind::kTorque;
  for (int n = 1; n <= kMostTurnPeriods; ++n) {
    all->push_back(Along(runs, units, {"", torque ? "psi" : "rad/s", [torque, n](const Known& at) {
                                         const double carrier = torque ? at.p2 - at.p1 : at.motor_speed;
                                         return carrier * std::cos(n * at.motor_angle);
                                       }}));
    all->back().name =
        std::string(torque ? "(p2 - p1)" : "motor_speed") + " cos(" + std::to_string(n) + " motor_angle)";
    all->back().linear_only = true;
  }
}

// A function of the held command, smoothed as the balances are.
template <class Of>
Variable OfCommand(const std::vector<LackingRun>& runs, const char* name, const Of& of) {
  Variable variable{name, "V", {}, false, {}, false};
  for (const LackingRun& run : runs) {
    std::vector<double> held = of(run.motion);
    for (size_t k = held.size(); k-- > 1;) held[k] = 0.5 * (held[k - 1] + held[k]);
    const std::vector<double> smooth = Smoothed(held, SmoothingOf(run.motion.step) / run.motion.step);
    std::vector<double> values(run.size());
    for (size_t i = 0; i < values.size(); ++i) values[i] = smooth[i * run.motion.stride];
    variable.values.push_back(std::move(values));
  }
  return variable;
}

std::vector<double> BeyondLimit(std::vector<double> voltage, double limit) {
  for (double& v : voltage) v -= std::clamp(v, -limit, limit);
  return voltage;
}

std::vector<double> AheadOfLag(const RunMotion& motion, double lag) {
  std::vector<double> ahead(motion.voltage);
  const double keeps = std::exp(-motion.step / lag);
  double behind = ahead.front();
  for (size_t k = 0; k < ahead.size(); ++k) {
    if (k > 0) behind = motion.voltage[k - 1] + (behind - motion.voltage[k - 1]) * keeps;
    ahead[k] = motion.voltage[k] - behind;
  }
  return ahead;
}

}  // namespace

std::vector<Variable> MotionVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                      const UnitSystem& units, bool quick) {
  std::vector<Variable> all;
  for (const VariableOfMotion& one : PlainVariables(balance)) all.push_back(Along(runs, units, one));
  if (quick && balance != BalanceKind::kArm) AddTurns(runs, balance, units, &all);
  all.push_back(Along(runs, units, {"time", "s", [](const Known& at) { return at.time; }, 0, true}));
  return all;
}

std::vector<Variable> CommandVariables(const std::vector<LackingRun>& runs) {
  std::vector<Variable> all;
  all.push_back(OfCommand(runs, "voltage", [](const RunMotion& motion) { return motion.voltage; }));
  double largest = 0;
  for (const LackingRun& run : runs) {
    for (const double v : run.motion.voltage) largest = std::max(largest, std::abs(v));
  }
  // A limit shows only beyond some voltage.
  for (const double part : {0.5, 0.65, 0.8, 0.9}) {
    const double limit = part * largest;
    all.push_back(OfCommand(runs, "voltage beyond a limit",
                            [limit](const RunMotion& motion) { return BeyondLimit(motion.voltage, limit); }));
    all.back().where = "|voltage| > " + ShortNumber(limit, 3) + " V";
    all.back().linear_only = true;
  }
  for (const double lag : {0.001, 0.002, 0.004, 0.008, 0.016, 0.032}) {
    all.push_back(OfCommand(runs, "change of voltage",
                            [lag](const RunMotion& motion) { return AheadOfLag(motion, lag); }));
    all.back().linear_only = true;
  }
  return all;
}

std::vector<Variable> LateVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                    const UnitSystem& units) {
  std::vector<VariableOfMotion> rates;
  if (balance == BalanceKind::kTorque) {
    rates = {{"p2 - p1 rate", "psi/s", [](const Known& at) { return at.p2_rate - at.p1_rate; }}};
  } else if (balance != BalanceKind::kArm) {
    rates = {{"motor_acceleration", "rad/s^2", [](const Known& at) { return at.motor_acceleration; }},
             {"arm_acceleration", "rad/s^2", [](const Known& at) { return at.arm_acceleration; }, 1}};
  }
  std::vector<Variable> all;
  for (const VariableOfMotion& rate : rates) {
    all.push_back(Along(runs, units, rate));
    all.back().linear_only = true;
  }
  return all;
}

}  // namespace hydro::diagnose
