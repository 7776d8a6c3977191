#include "diagnose/say/variables.h"

#include <functional>

#include "base/number_text.h"

namespace hydro::diagnose {
namespace {

using Known = model::KnownMotion;
using std::numbers::pi;

constexpr int kMostTurnPeriods = 24;  // per turn

constexpr unsigned Bit(BalanceKind balance) { return 1U << static_cast<unsigned>(balance); }
constexpr unsigned kTorque = Bit(BalanceKind::kTorque), kFlow1 = Bit(BalanceKind::kFlow1),
                   kFlow2 = Bit(BalanceKind::kFlow2), kArm = Bit(BalanceKind::kArm),
                   kPump = kTorque | kFlow1 | kFlow2;

// Whether a balance may depend on the variable, or it only names a dependence, or it belongs to a late
// reading.
enum class Use { kMayShow, kOnlyNames, kLate };

// `unit` is the paper's unit, `arm` the power of the arm's coordinate in it.
struct MotionRow {
  unsigned balances;
  Use use;
  const char* name;
  const char* unit;
  int arm;
  double (*of)(const Known&);
};

// Simplest variables first.
constexpr MotionRow kRows[] = {
    {kArm, Use::kMayShow, "arm_speed", "rad/s", 1, [](const Known& at) { return at.arm_speed; }},
    {kArm, Use::kMayShow, "arm_angle", "rad", 1, [](const Known& at) { return at.arm_angle; }},
    {kPump, Use::kMayShow, "motor_speed", "rad/s", 0, [](const Known& at) { return at.motor_speed; }},
    {kTorque, Use::kMayShow, "p1 + p2", "psi", 0, [](const Known& at) { return at.p1 + at.p2; }},
    {kTorque, Use::kMayShow, "(p1 + p2) sgn(motor_speed)", "psi", 0,
     [](const Known& at) { return std::copysign(at.p1 + at.p2, at.motor_speed); }},
    {kFlow1, Use::kMayShow, "p1", "psi", 0, [](const Known& at) { return at.p1; }},
    {kFlow2, Use::kMayShow, "p2", "psi", 0, [](const Known& at) { return at.p2; }},
    {kTorque, Use::kOnlyNames, "motor_acceleration", "rad/s^2", 0,
     [](const Known& at) { return at.motor_acceleration; }},
    {kFlow1, Use::kOnlyNames, "p1 rate", "psi/s", 0, [](const Known& at) { return at.p1_rate; }},
    {kFlow2, Use::kOnlyNames, "p2 rate", "psi/s", 0, [](const Known& at) { return at.p2_rate; }},
    {kPump | kArm, Use::kOnlyNames, "p2 - p1", "psi", 0, [](const Known& at) { return at.p2 - at.p1; }},
    {kPump, Use::kMayShow, "arm_angle", "rad", 1, [](const Known& at) { return at.arm_angle; }},
    {kPump, Use::kOnlyNames, "arm_speed", "rad/s", 1, [](const Known& at) { return at.arm_speed; }},
    {kPump | kArm, Use::kOnlyNames, "time", "s", 0, [](const Known& at) { return at.time; }},
    {kTorque, Use::kLate, "p2 - p1 rate", "psi/s", 0,
     [](const Known& at) { return at.p2_rate - at.p1_rate; }},
    {kFlow1 | kFlow2, Use::kLate, "motor_acceleration", "rad/s^2", 0,
     [](const Known& at) { return at.motor_acceleration; }},
    {kFlow1 | kFlow2, Use::kLate, "arm_acceleration", "rad/s^2", 1,
     [](const Known& at) { return at.arm_acceleration; }},
};

Variable Along(const std::vector<LackingRun>& runs, Variable variable,
               const std::function<double(const Known&)>& of) {
  for (const LackingRun& run : runs) {
    std::vector<double>& values = variable.values.emplace_back(run.size());
    for (size_t i = 0; i < values.size(); ++i) values[i] = of(run.At(i));
  }
  return variable;
}

bool Pressures(const std::vector<LackingRun>& runs) {
  return std::ranges::any_of(runs, [](const LackingRun& run) { return run.motion.pressures; });
}

// A function of the held command, smoothed as the balances are.
template <class Of>
Variable OfCommand(const std::vector<LackingRun>& runs, const char* name, const Of& of) {
  Variable variable{name, "V"};
  for (const LackingRun& run : runs) {
    std::vector<double> held = of(run.motion);
    for (size_t k = held.size(); k-- > 1;) held[k] = 0.5 * (held[k - 1] + held[k]);
    const std::vector<double> smooth = Smoothed(held, SmoothingOf(run.motion.step) / run.motion.step);
    std::vector<double>& values = variable.values.emplace_back(run.size());
    for (size_t i = 0; i < values.size(); ++i) values[i] = smooth[i * run.motion.stride];
  }
  variable.line = std::string(name) != "voltage";
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
                                      const UnitSystem& units, bool turns) {
  const bool pressures = Pressures(runs);
  std::vector<Variable> all;
  for (const MotionRow& row : kRows) {
    const bool of_pressure = std::string(row.unit).starts_with("psi");
    if (row.use == Use::kLate || (row.balances & Bit(balance)) == 0 || (of_pressure && !pressures)) continue;
    const bool names = row.use == Use::kOnlyNames;
    all.push_back(Along(runs, {row.name, units.UnitFor(row.unit, row.arm), {}, names, names}, row.of));
  }
  if (!turns || balance == BalanceKind::kArm) return all;
  for (int periods = 1; periods <= kMostTurnPeriods; ++periods) AddTurn(runs, balance, units, periods, &all);
  return all;
}

void AddTurn(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units,
             double periods, std::vector<Variable>* all) {
  const bool torque = balance == BalanceKind::kTorque;
  const std::string times = ShortNumber(periods, 4);
  all->push_back(
      Along(runs, {"motor_angle, " + times + " periods a turn", "rad"},
            [periods](const Known& at) { return std::remainder(periods * at.motor_angle, 2 * pi); }));
  if (torque && !Pressures(runs)) return;
  all->push_back(Along(runs,
                       {(torque ? "(p2 - p1)" : "motor_speed") + (" cos(" + times + " motor_angle)"),
                        torque ? units.UnitFor("psi") : "rad/s"},
                       [torque, periods](const Known& at) {
                         return (torque ? at.p2 - at.p1 : at.motor_speed) *
                                std::cos(periods * at.motor_angle);
                       }));
  all->back().line = true;
}

std::vector<Variable> CommandVariables(const std::vector<LackingRun>& runs) {
  std::vector<Variable> all = {
      OfCommand(runs, "voltage", [](const RunMotion& motion) { return motion.voltage; })};
  double largest = 0;
  for (const LackingRun& run : runs) {
    for (const double v : run.motion.voltage) largest = std::max(largest, std::abs(v));
  }
  // A limit shows only above some voltage.
  for (const double part : {0.5, 0.65, 0.8, 0.9}) {
    const double limit = part * largest;
    all.push_back(OfCommand(runs, "voltage beyond a limit",
                            [limit](const RunMotion& motion) { return BeyondLimit(motion.voltage, limit); }));
    all.back().where = "|voltage| > " + ShortNumber(limit, 3) + " V";
  }
  for (const double lag : {0.001, 0.002, 0.004, 0.008, 0.016, 0.032}) {
    all.push_back(OfCommand(runs, "change of voltage",
                            [lag](const RunMotion& motion) { return AheadOfLag(motion, lag); }));
  }
  return all;
}

std::vector<Variable> LateVariables(const std::vector<LackingRun>& runs, BalanceKind balance,
                                    const UnitSystem& units) {
  std::vector<Variable> all;
  for (const MotionRow& row : kRows) {
    if (row.use != Use::kLate || (row.balances & Bit(balance)) == 0) continue;
    all.push_back(Along(runs, {row.name, units.UnitFor(row.unit, row.arm), {}, false, true}, row.of));
  }
  return all;
}

}  // namespace hydro::diagnose
