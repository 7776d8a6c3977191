#include "diagnose/say/measured_curves.h"

#include <utility>

#include "base/parallel.h"
#include "diagnose/say/binned_curve.h"
#include "diagnose/say/variables.h"

namespace hydro::diagnose {
namespace {

using model::Parameters;

// s: long enough for the noise of a derivative to average out and for a pump's speed to stay nearly constant.
// Waves within a turn need shorter blocks.
constexpr double kCurveBlock = 0.016, kWaveBlock = 0.002;

// A balance, and the sign with which the element counts in what the balance leaves without it.
struct Part {
  BalanceKind balance;
  double sign;
};

// One element of the machine: its terms of eqs. (4), (13), (14), (15).
struct Element {
  std::string name, variable;
  std::vector<Part> parts;
  std::vector<double Parameters::*> values;
  std::string effects;  // the beginning of the ids of effects that may belong to it
  std::string closure;  // the same for closures over `variable`
};

std::vector<Element> AllElements() {
  using enum BalanceKind;
  return {
      {"pump_friction",
       "motor_speed",
       {{kTorque, 1}},
       {&Parameters::b, &Parameters::T_s, &Parameters::f},
       "pump.",
       "closure.pump_torque"},
      {"cross_leakage", "p2 - p1", {{kFlow1, -1}, {kFlow2, 1}}, {&Parameters::c_I}, "pump.", "closure.flow_"},
      {"arm_load", "arm_angle", {{kArm, 1}}, {&Parameters::mgl}, "arm.", "closure.arm_torque"}};
}

bool IsWave(const model::EffectDescription& effect) { return effect.parameters.contains("periods"); }

// The pump's and the arm's effects, including the user's own, that act without delay. An effect that repeats
// with the turn is no friction, and a flexible arm is no load.
bool Belongs(const Element& element, const model::EffectDescription& effect) {
  if (effect.id.starts_with(element.closure)) {
    const auto against = effect.name_lists.find("against");
    return against != effect.name_lists.end() && against->second.front() == element.variable;
  }
  return effect.id.starts_with(element.effects) && effect.id != "arm.flexure" && !IsWave(effect);
}

// What a part of `model` does along the runs' motion: what the model leaves without the part and not with it.
// `base` is what it leaves with the part.
std::vector<BalanceSeries> AlongRuns(const model::ModelDescription& without,
                                     const std::vector<LackingRun>& runs, const std::vector<BaseSeries>& base,
                                     int jobs) {
  std::vector<BalanceSeries> all(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { all[r] = Beyond(without, runs[r].motion, base[r]); });
  return all;
}

std::vector<BalanceSeries> AlongRuns(const Element& element, model::ModelDescription model,
                                     const std::vector<LackingRun>& runs, const std::vector<BaseSeries>& base,
                                     int jobs) {
  for (double Parameters::*value : element.values) model.parameters.*value = 0;
  std::erase_if(model.effects, [&](const auto& effect) { return Belongs(element, effect); });
  return AlongRuns(model, runs, base, jobs);
}

// How blocks become points: the length of a block, s, and the speed, rad/s, above which a block covers too
// much of a wave to count.
struct Sampling {
  double block = kCurveBlock;
  double fastest = std::numeric_limits<double>::infinity();
};

// A block covers at most a quarter of a wave.
Sampling SamplingOf(const model::EffectDescription& effect) {
  if (!IsWave(effect)) return {};
  return {kWaveBlock, 0.25 * 2 * std::numbers::pi / (2 * kWaveBlock * effect.parameters.at("periods"))};
}

// Blocks of one balance over the variable: what is left with the element, and the element itself. `given` may
// be empty.
void AddPoints(const Part& part, const Variable& variable, const Sampling& sampling,
               const std::vector<LackingRun>& runs, const std::vector<BalanceSeries>& given,
               const std::vector<BalanceSeries>& found, std::vector<CurvePoint>* points) {
  for (const Block& block : BlocksOf(runs, part.balance, sampling.block)) {
    const LackingRun& run = runs[block.run];
    const std::vector<double>& values = variable.values[block.run];
    const size_t middle = (block.first + block.end) / 2;
    if (std::abs(run.At(middle).motor_speed) > sampling.fastest) continue;
    // A phase has no mean.
    const bool wave = std::isfinite(sampling.fastest);
    CurvePoint point{
        wave ? values[middle] : MeanOver(block, run, part.balance, [&](size_t i) { return values[i]; }), 0,
        block.noise};
    if (!given.empty()) point.given = part.sign * MeanOver(block, run, part.balance, given[block.run]);
    point.found = part.sign * MeanOver(block, run, part.balance, found[block.run]);
    point.measured = point.found - part.sign * block.value;
    if (std::isfinite(point.found)) points->push_back(point);
  }
}

MeasuredCurve CurveOf(BinnedCurve curve, const std::string& element, BalanceKind balance,
                      const Variable& variable, const UnitSystem& units) {
  return {element,
          NameOf(balance),
          UnitOf(balance, units),
          variable.name,
          variable.unit,
          std::move(curve.at),
          std::move(curve.measured),
          std::move(curve.error),
          std::move(curve.given),
          std::move(curve.found)};
}

// The part of the square of the points' `found` that is no function of the variable, and the size of that
// square relative to the noise.
struct OverVariable {
  double left = 1, energy = 0;
};

OverVariable LeftOver(std::vector<CurvePoint> points) {
  double squares = 0, noise = 0;
  for (CurvePoint& point : points) {
    squares += point.found * point.found;
    noise += point.noise * point.noise;
    point.measured = point.found;
    point.noise = 1;
  }
  const BinnedCurve curve = Binned(std::move(points));
  return {squares > 0 && curve.size() > 0 ? curve.left / squares : 1, squares / noise};
}

// An angle that no sensor saw begins anywhere in each run, so that curves of different runs cannot be
// superposed.
bool SeeAngles(const std::vector<LackingRun>& runs) {
  return std::ranges::all_of(
      runs, [](const LackingRun& run) { return run.motion.Of(GridChannel::kAngle).measured(); });
}

}  // namespace

std::vector<MeasuredCurve> MeasuredCurves(const model::ModelDescription& given,
                                          const model::ModelDescription& found,
                                          const std::vector<const RunData*>& runs, int jobs) {
  const std::vector<LackingRun> lacking = LackingIn(found, runs, jobs);
  std::vector<BaseSeries> base_given(runs.size()), base_found(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    base_given[r] = SeriesOf(given, lacking[r].motion);
    base_found[r] = lacking[r].base;
  });
  std::vector<MeasuredCurve> curves;
  for (const Element& element : AllElements()) {
    const BalanceKind balance = element.parts.front().balance;
    const std::vector<Variable> variables = MotionVariables(lacking, balance, found.units, false);
    const auto variable =
        std::ranges::find_if(variables, [&](const Variable& one) { return one.name == element.variable; });
    if (variable == variables.end()) continue;
    const std::vector<BalanceSeries> by_given = AlongRuns(element, given, lacking, base_given, jobs),
                                     by_found = AlongRuns(element, found, lacking, base_found, jobs);
    std::vector<CurvePoint> points;
    for (const Part& part : element.parts)
      AddPoints(part, *variable, {}, lacking, by_given, by_found, &points);
    BinnedCurve curve = Binned(std::move(points));
    if (curve.size() == 0) continue;
    curves.push_back(CurveOf(std::move(curve), element.name, balance, *variable, found.units));
  }
  return curves;
}

std::optional<MeasuredCurve> TermOf(const model::ModelDescription& model, const std::string& effect,
                                    const std::vector<const RunData*>& runs, int jobs) {
  const auto is_it = [&](const model::EffectDescription& one) { return one.id == effect; };
  const auto description = std::ranges::find_if(model.effects, is_it);
  if (description == model.effects.end()) return std::nullopt;
  const Sampling sampling = SamplingOf(*description);
  model::ModelDescription without = model;
  std::erase_if(without.effects, is_it);
  const std::vector<LackingRun> lacking = LackingIn(model, runs, jobs);
  if (IsWave(*description) && lacking.size() > 1 && !SeeAngles(lacking)) return std::nullopt;
  std::vector<BaseSeries> base;
  base.reserve(lacking.size());
  for (const LackingRun& run : lacking) base.push_back(run.base);
  const std::vector<BalanceSeries> effects = AlongRuns(without, lacking, base, jobs);
  std::optional<MeasuredCurve> best;
  double most = 0;
  for (const BalanceKind balance :
       {BalanceKind::kTorque, BalanceKind::kFlow1, BalanceKind::kFlow2, BalanceKind::kArm}) {
    double least = kFarLess;
    std::vector<Variable> variables = MotionVariables(lacking, balance, model.units, false);
    if (IsWave(*description))
      AddTurn(lacking, balance, model.units, description->parameters.at("periods"), &variables);
    for (const Variable& variable : variables) {
      std::vector<CurvePoint> points;
      AddPoints({balance, -1}, variable, sampling, lacking, {}, effects, &points);
      const OverVariable shown = LeftOver(points);
      if (shown.left > least || shown.energy < most) continue;
      least = kFarLess * shown.left;
      most = shown.energy;
      best = CurveOf(Binned(std::move(points)), effect, balance, variable, model.units);
      best->model.clear();
    }
  }
  return best;
}

}  // namespace hydro::diagnose
