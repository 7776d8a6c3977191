#include "diagnose/say/effect_term.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "diagnose/say/dependence.h"

namespace hydro::diagnose {

namespace {

// The effect's term is averaged over so many steps of its variable.
constexpr size_t kTermSteps = 60;

// s: short against what the terms vary by, but for waves of a turn.
constexpr double kTermBlock = 0.016, kWaveBlock = 0.002;

struct OwnRow {
  const char* effect;
  BalanceKind balance;
  const char* variable;
};

constexpr OwnRow kOwnRows[] = {
    {"actuator.seal_friction", BalanceKind::kArm, "arm_speed"},
    {"amp.bias", BalanceKind::kTorque, "motor_speed"},
    {"fluid.entrained_air", BalanceKind::kFlow1, "p1 rate"},
    {"fluid.entrained_air", BalanceKind::kFlow2, "p2 rate"},
    {"fluid.stiffening", BalanceKind::kFlow1, "p1 rate"},
    {"fluid.stiffening", BalanceKind::kFlow2, "p2 rate"},
    {"fluid.warming", BalanceKind::kTorque, "time"},
    {"motor.speed_torque_limit", BalanceKind::kTorque, "motor_speed"},
    {"pump.friction_asymmetry", BalanceKind::kTorque, "motor_speed"},
    {"pump.pressure_friction", BalanceKind::kTorque, "(p1 + p2) sgn(motor_speed)"},
    {"pump.quadratic_drag", BalanceKind::kTorque, "motor_speed"},
    {"pump.stribeck", BalanceKind::kTorque, "motor_speed"},
    {"pump.turbulent_leakage", BalanceKind::kFlow1, "p2 - p1"},
    {"pump.turbulent_leakage", BalanceKind::kFlow2, "p2 - p1"},
    {"valve.relief", BalanceKind::kFlow1, "p1"},
    {"valve.relief", BalanceKind::kFlow2, "p2"},
};

struct Point {
  double at = 0, value = 0;
};

// What the effect adds along the runs.
std::vector<Point> PointsAlong(const std::vector<LackingRun>& runs, const std::vector<BalanceSeries>& added,
                               const OwnVariable& own, const Variable& variable) {
  const auto b = static_cast<size_t>(own.balance);
  std::vector<Point> points;
  for (size_t r = 0; r < runs.size(); ++r) {
    for (size_t i = 0; i < runs[r].size(); ++i) {
      if (!runs[r].Says(own.balance, i)) continue;
      const double value = added[r][b][static_cast<Eigen::Index>(i)];
      if (std::isfinite(value)) points.push_back({variable.values[r][i], value});
    }
  }
  return points;
}

// Means over equal steps of the variable.
void SetCurve(const std::vector<Point>& points, FoundTerm* term) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Point& point : points) {
    low = std::min(low, point.at);
    high = std::max(high, point.at);
  }
  if (!(high > low)) return;
  std::vector<double> sum(kTermSteps, 0.0), count(kTermSteps, 0.0);
  for (const Point& point : points) {
    const auto step = static_cast<size_t>((point.at - low) / (high - low) * kTermSteps);
    sum[std::min(step, kTermSteps - 1)] += point.value;
    count[std::min(step, kTermSteps - 1)] += 1;
  }
  for (size_t s = 0; s < kTermSteps; ++s) {
    if (count[s] == 0) continue;
    term->at.push_back(low + (high - low) * (static_cast<double>(s) + 0.5) / kTermSteps);
    term->value.push_back(sum[s] / count[s]);
  }
}

double LargestOf(const FoundTerm& term) {
  double largest = 0;
  for (const double value : term.value) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

std::vector<OwnVariable> OwnVariables(const model::EffectDescription& effect) {
  std::vector<OwnVariable> own;
  for (const OwnRow& row : kOwnRows) {
    if (effect.id == row.effect) own.push_back({row.balance, row.variable});
  }
  const auto found = effect.parameters.find("periods");
  const long whole = found == effect.parameters.end() ? 0 : std::lround(found->second);
  const std::string periods = std::to_string(whole);
  if (effect.id == "motor.cogging") {
    own.push_back({BalanceKind::kTorque, "motor_angle, " + periods + " periods a turn"});
  }
  if (effect.id == "pump.flow_ripple") {
    own.push_back({BalanceKind::kFlow1, "motor_speed cos(" + periods + " motor_angle)"});
    own.push_back({BalanceKind::kTorque, "(p2 - p1) cos(" + periods + " motor_angle)"});
  }
  return own;
}

std::optional<FoundTerm> TermOf(const model::ModelDescription& model, const std::string& effect,
                                const std::vector<const RunData*>& runs, int jobs) {
  const auto is_it = [&](const model::EffectDescription& one) { return one.id == effect; };
  const auto description = std::find_if(model.effects.begin(), model.effects.end(), is_it);
  if (description == model.effects.end()) return std::nullopt;
  const std::vector<OwnVariable> owns = OwnVariables(*description);
  if (owns.empty()) return std::nullopt;
  model::ModelDescription without = model;
  std::erase_if(without.effects, is_it);
  const std::vector<LackingRun> lacking = LackingIn(without, runs, jobs);
  std::vector<BalanceSeries> added(runs.size());
  ParallelFor(runs.size(), jobs,
              [&](size_t r) { added[r] = Beyond(model, lacking[r].motion, lacking[r].base); });
  FoundTerm found;
  for (const OwnVariable& own : owns) {
    std::vector<Variable> variables = MotionVariables(lacking, own.balance, model.units, true);
    const auto variable = std::find_if(variables.begin(), variables.end(),
                                       [&](const Variable& one) { return one.name == own.variable; });
    if (variable == variables.end()) continue;
    FoundTerm term;
    SetCurve(PointsAlong(lacking, added, own, *variable), &term);
    if (!(LargestOf(term) > LargestOf(found))) continue;
    const bool wave = description->parameters.contains("periods");
    const Blocks blocks = BlocksOf(lacking, own.balance, wave ? kWaveBlock : kTermBlock);
    term.missing = TableOf(blocks, *variable, Average(*variable, blocks, lacking, own.balance));
    term.missing.balance = NameOf(own.balance);
    term.missing.unit = UnitOf(own.balance, model.units);
    term.effect = effect;
    found = std::move(term);
  }
  if (found.effect.empty()) return std::nullopt;
  return found;
}

}  // namespace hydro::diagnose
