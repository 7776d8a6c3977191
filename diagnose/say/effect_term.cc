#include "diagnose/say/effect_term.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "diagnose/say/binned_curve.h"
#include "diagnose/say/dependence.h"

namespace hydro::diagnose {

namespace {

// s: short against what the terms vary by, but for waves of a turn.
constexpr double kTermBlock = 0.008, kWaveBlock = 0.002;

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

// What the runs lack in the balance, and what the effect adds there.
FoundTerm TermOver(const std::vector<LackingRun>& runs, const std::vector<BalanceSeries>& added,
                   BalanceKind balance, const Variable& variable, double duration) {
  const auto b = static_cast<size_t>(balance);
  const Blocks blocks = BlocksOf(runs, balance, duration);
  const std::vector<double> at = Average(variable, blocks, runs, balance);
  std::vector<CurvePoint> points;
  for (size_t k = 0; k < at.size(); ++k) {
    const Blocks::Block& block = blocks.blocks[k];
    const double adds = MeanOver(block, runs[block.run], balance,
                                 [&](size_t i) { return added[block.run][b][static_cast<Eigen::Index>(i)]; });
    if (std::isfinite(adds)) points.push_back({at[k], block.value, block.noise, 0, adds});
  }
  BinnedCurve curve = Binned(std::move(points));
  FoundTerm term;
  term.at = curve.at;
  term.value = std::move(curve.found);
  term.missing.against = variable.name;
  term.missing.against_unit = variable.unit;
  term.missing.at = std::move(curve.at);
  term.missing.mean = std::move(curve.measured);
  term.missing.error = std::move(curve.error);
  return term;
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
  const double duration = description->parameters.contains("periods") ? kWaveBlock : kTermBlock;
  FoundTerm found;
  for (const OwnVariable& own : owns) {
    std::vector<Variable> variables = MotionVariables(lacking, own.balance, model.units, true);
    const auto variable = std::find_if(variables.begin(), variables.end(),
                                       [&](const Variable& one) { return one.name == own.variable; });
    if (variable == variables.end()) continue;
    FoundTerm term = TermOver(lacking, added, own.balance, *variable, duration);
    if (!(LargestOf(term) > LargestOf(found))) continue;
    term.missing.balance = NameOf(own.balance);
    term.missing.unit = UnitOf(own.balance, model.units);
    term.effect = effect;
    found = std::move(term);
  }
  if (found.effect.empty()) return std::nullopt;
  return found;
}

}  // namespace hydro::diagnose
