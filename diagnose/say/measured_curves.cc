#include "diagnose/say/measured_curves.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "diagnose/say/binned_curve.h"
#include "diagnose/say/dependence.h"

namespace hydro::diagnose {

namespace {

using model::Parameters;

// s: noise of a derivative averages out, and a pump hardly changes its speed.
constexpr double kCurveBlock = 0.016;
constexpr size_t kFewestBins = 3;

// One element of the machine: its terms of eqs. (4), (13), (14), (15).
struct Element {
  const char* name;
  const char* variable;
  std::vector<BalanceKind> balances;
  std::vector<double> signs;  // of what the balances leave without the element, as the element counts
  std::vector<double Parameters::*> values;
  std::vector<std::string> effects;
  const char* closure;  // the beginning of the ids of closures over `variable` that belong to it
};

std::vector<Element> AllElements() {
  using enum BalanceKind;
  return {{"pump_friction",
           "motor_speed",
           {kTorque},
           {1},
           {&Parameters::b, &Parameters::T_s, &Parameters::f},
           {"pump.stribeck", "pump.pressure_friction", "pump.quadratic_drag", "pump.friction_asymmetry"},
           "closure.pump_torque"},
          {"cross_leakage",
           "p2 - p1",
           {kFlow1, kFlow2},
           {-1, 1},
           {&Parameters::c_I},
           {"pump.turbulent_leakage"},
           "closure.flow_"},
          {"arm_load", "arm_angle", {kArm}, {1}, {&Parameters::mgl}, {}, "closure.arm_torque"}};
}

bool IsClosureOf(const Element& element, const model::EffectDescription& effect) {
  if (!effect.id.starts_with(element.closure)) return false;
  const auto against = effect.name_lists.find("against");
  return against != effect.name_lists.end() && against->second.front() == element.variable;
}

// The user's own effects on the arm, a spring, say, belong to the load.
bool Belongs(const Element& element, const model::EffectDescription& effect) {
  const bool listed =
      std::find(element.effects.begin(), element.effects.end(), effect.id) != element.effects.end();
  const bool load =
      std::string(element.name) == "arm_load" && effect.id.starts_with("arm.") && effect.id != "arm.flexure";
  return listed || load || IsClosureOf(element, effect);
}

model::ModelDescription WithoutElement(model::ModelDescription model, const Element& element) {
  for (double Parameters::*value : element.values) model.parameters.*value = 0;
  std::erase_if(model.effects, [&](const auto& effect) { return Belongs(element, effect); });
  return model;
}

// What the element of `model` does along the runs' motion: what the model leaves without it and not with it. `base`: what
// it leaves with it.
std::vector<BalanceSeries> AlongRuns(const Element& element, const model::ModelDescription& model,
                                     const std::vector<LackingRun>& runs, const std::vector<BaseSeries>& base,
                                     int jobs) {
  const model::ModelDescription without = WithoutElement(model, element);
  std::vector<BalanceSeries> all(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { all[r] = Beyond(without, runs[r].motion, base[r]); });
  return all;
}

void AddBalance(BalanceKind balance, double sign, const Variable& variable,
                const std::vector<LackingRun>& runs, const std::vector<BalanceSeries>& given,
                const std::vector<BalanceSeries>& found, std::vector<CurvePoint>* points) {
  const auto b = static_cast<size_t>(balance);
  const Blocks blocks = BlocksOf(runs, balance, kCurveBlock);
  const std::vector<double> at = Average(variable, blocks, runs, balance);
  for (size_t i = 0; i < at.size(); ++i) {
    const Blocks::Block& block = blocks.blocks[i];
    const auto mean = [&](const std::vector<BalanceSeries>& series) {
      return sign * MeanOver(block, runs[block.run], balance, [&](size_t instant) {
               return series[block.run][b][static_cast<Eigen::Index>(instant)];
             });
    };
    CurvePoint point{at[i], 0, block.noise, mean(given), mean(found)};
    // What is left with the element, and the element itself.
    point.measured = point.found - sign * block.value;
    points->push_back(point);
  }
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
    std::vector<Variable> variables = MotionVariables(lacking, element.balances.front(), found.units, false);
    const auto variable = std::find_if(variables.begin(), variables.end(),
                                       [&](const Variable& one) { return one.name == element.variable; });
    const std::vector<BalanceSeries> by_given = AlongRuns(element, given, lacking, base_given, jobs),
                                     by_found = AlongRuns(element, found, lacking, base_found, jobs);
    std::vector<CurvePoint> points;
    for (size_t k = 0; k < element.balances.size(); ++k) {
      AddBalance(element.balances[k], element.signs[k], *variable, lacking, by_given, by_found, &points);
    }
    BinnedCurve curve = Binned(std::move(points));
    if (curve.at.size() < kFewestBins) continue;
    curves.push_back({element.name, UnitOf(element.balances.front(), found.units), variable->name,
                      variable->unit, std::move(curve.at), std::move(curve.measured), std::move(curve.error),
                      std::move(curve.given), std::move(curve.found)});
  }
  return curves;
}

}  // namespace hydro::diagnose
