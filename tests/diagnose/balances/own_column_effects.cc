// Effects of a user's own, written as text: one that changes the motor's torque in proportion, one that
// changes flows and the arm in proportion, and one with a state. The tests of columns go through the
// catalogue, and so through these.
#include <memory>

#include "model/effects/formulas.h"

namespace hydro::testing {
namespace {

using model::EffectInfo;
using model::EffectText;

bool Add(EffectInfo info, EffectText text) {
  return model::AddToCatalogue(
      model::EntryOf(std::make_shared<const model::EffectFormulas>(std::move(info), std::move(text))));
}

EffectInfo InfoOf(const char* id, const char* equation, std::vector<model::ParameterInfo> parameters) {
  return {.id = id,
          .summary = "an effect of a user's own",
          .equation = equation,
          .confused_with = "others",
          .parameters = std::move(parameters)};
}

model::ParameterInfo Amount(const char* name, const char* unit) {
  return {.name = name,
          .unit = unit,
          .min = -model::kUnbounded,
          .meaning = "how much of it there is",
          .example = 0.1};
}

EffectText Text(std::vector<std::string> equation) {
  EffectText text;
  text.equation = std::move(equation);
  return text;
}

EffectText Creep() {
  EffectText text = Text({"cross_flow += flow * creep"});
  model::StateText state;
  state.name = "creep";
  state.unit = "1";
  state.rate = "((p2 - p1) / 1000 - creep) / 0.05";
  state.start = "0";
  text.states.push_back(state);
  return text;
}

[[maybe_unused]] const bool kAdded =
    Add(InfoOf("own.back_emf", "T_p -= k theta'", {Amount("k", "in-lbf-s")}),
        Text({"torque -= k * motor_speed"})) &&
    Add(InfoOf("own.vent", "flow k p out of side 1, arm torque - k2 alpha",
               {Amount("k", "in^3/s/psi"), Amount("k2", "in-lbf/rad")}),
        Text({"outer_flow_1 += k * p1", "arm_torque -= k2 * arm_angle"})) &&
    Add(InfoOf("own.creep", "leakage that follows the pressures", {Amount("flow", "in^3/s")}), Creep());

}  // namespace
}  // namespace hydro::testing
