#include "diagnose/locate/effect_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "diagnose/locate/dependence.h"
#include "diagnose/locate/disagreement.h"
#include "diagnose/locate/explanations.h"
#include "diagnose/locate/locate.h"
#include "diagnose/locate/own_variable.h"
#include "diagnose/locate/smoother_setup.h"
#include "model/equations/equations.h"

namespace hydro::diagnose {

namespace {

// The effect's term is evaluated at about so many samples of each run, and averaged over so many steps of its
// variable.
constexpr size_t kSamplesOfARun = 2000;
constexpr size_t kTermSteps = 60;

model::ModelDescription WithoutEffect(const model::ModelDescription& model, const std::string& effect) {
  model::ModelDescription without = model;
  std::erase_if(without.effects, [&](const model::EffectDescription& one) { return one.id == effect; });
  return without;
}

model::ModelDescription OnlyWith(const model::ModelDescription& model,
                                 const model::EffectDescription& effect) {
  model::ModelDescription only = model;
  only.effects = {effect};
  return only;
}

// The right-hand side at one sample, the pump turning as it does there.
struct Instant {
  double rate[model::kMaxStates] = {};
  model::Terms<double> terms;
};

Instant At(const model::Equations& equations, double time, double voltage, const double* state) {
  model::Mode mode;
  mode.pump = state[model::kMotorSpeed] > 0 ? 1 : -1;
  Instant instant;
  double margin[model::kMaxSwitches];
  double copy[model::kMaxStates];
  for (int i = 0; i < equations.states(); ++i) copy[i] = state[i];
  equations.Rates(time, voltage, mode, copy, instant.rate, margin);
  for (int s = model::kFirstEffectSwitch; s < equations.switches(); ++s) {
    if (margin[s] < 0) equations.Cross(s, time, voltage, copy, &mode);
  }
  equations.Evaluate(time, voltage, mode, state, instant.rate, &instant.terms);
  return instant;
}

// The torque or flow that one has and the other lacks.
double Between(const Instant& with, const Instant& without, Balance balance, const model::Parameters& p) {
  const model::Terms<double>&a = with.terms, &b = without.terms;
  switch (balance) {
    case Balance::kPumpTorque:
      return p.J * (with.rate[model::kMotorSpeed] - without.rate[model::kMotorSpeed]);
    case Balance::kFlow1:
      return (a.free_rate_1 - b.free_rate_1) * b.V_1 / b.beta_1;
    case Balance::kFlow2:
      return (a.free_rate_2 - b.free_rate_2) * b.V_2 / b.beta_2;
    case Balance::kArmTorque:
      return p.J_a * (with.rate[model::kArmSpeed] - without.rate[model::kArmSpeed]);
  }
  return 0;
}

struct Point {
  double at = 0, value = 0;
};

// Adds the effect's term along a run.
void AddAlong(const model::ModelDescription& only, const RunData& run, const SmoothedRun& smoothed,
              const OwnVariable& own, const std::vector<double>& variable, std::vector<Point>* points) {
  const auto b = static_cast<size_t>(own.balance);
  if (!smoothed.measured[b]) return;
  const model::ActuatorOptions options = smoother::OptionsOf(run);
  const model::Equations with(only, options), without(WithoutEffect(only, only.effects.front().id), options);
  if (with.states() != without.states()) return;
  const size_t stride = std::max<size_t>(1, run.samples() / kSamplesOfARun);
  for (size_t k = 0; k < run.samples(); k += stride) {
    if (smoothed.disturbance[b].informative[k] == 0) continue;
    double state[model::kMaxStates] = {smoothed.motor_angle[k], smoothed.motor_speed[k],
                                       smoothed.p1[k],          smoothed.p2[k],
                                       smoothed.arm_angle[k],   smoothed.arm_speed[k]};
    const double time = run.stimulus.time[k], voltage = run.stimulus.voltage[k];
    const double value = Between(At(with, time, voltage, state), At(without, time, voltage, state),
                                 own.balance, only.parameters);
    if (std::isfinite(value)) points->push_back({variable[k], value});
  }
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

const Variable* Find(const std::vector<Variable>& variables, const std::string& name) {
  for (const Variable& variable : variables) {
    if (variable.name == name) return &variable;
  }
  return nullptr;
}

double LargestOf(const FoundTerm& term) {
  double largest = 0;
  for (const double value : term.value) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

std::optional<FoundTerm> TermOf(const model::ModelDescription& model, const std::string& effect,
                                const std::vector<const RunData*>& runs, int jobs) {
  const auto description =
      std::find_if(model.effects.begin(), model.effects.end(),
                   [&](const model::EffectDescription& one) { return one.id == effect; });
  if (description == model.effects.end()) return std::nullopt;
  const std::vector<OwnVariable> owns = OwnVariables(*description);
  if (owns.empty()) return std::nullopt;
  const model::ModelDescription only = OnlyWith(model, *description), without = WithoutEffect(model, effect);
  std::vector<SmoothedRun> smoothed(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { smoothed[r] = SmoothDisturbances(without, *runs[r], {}); });
  const Explanations explanations(smoothed, runs, model.units);
  FoundTerm found;
  for (const OwnVariable& own : owns) {
    const std::vector<Variable> variables = explanations.States(own.balance, true);
    const Variable* variable = Find(variables, own.variable);
    if (variable == nullptr) continue;
    std::vector<Point> points;
    for (size_t r = 0; r < runs.size(); ++r) {
      AddAlong(only, *runs[r], smoothed[r], own, variable->values[r], &points);
    }
    FoundTerm term;
    SetCurve(points, &term);
    if (!(LargestOf(term) > LargestOf(found))) continue;
    const Blocks blocks = LargestDisagreement(smoothed, runs, own.balance).blocks;
    term.missing = TableOf(blocks, *variable, Average(*variable, blocks, smoothed, own.balance));
    term.missing.balance = NameOf(own.balance);
    term.missing.unit = UnitOf(own.balance, model.units);
    term.effect = effect;
    found = std::move(term);
  }
  if (found.effect.empty()) return std::nullopt;
  return found;
}

}  // namespace hydro::diagnose
