#include "diagnose/locate/own_variable.h"

#include <cmath>

namespace hydro::diagnose {

namespace {

struct Row {
  const char* effect;
  Balance balance;
  const char* variable;
};

constexpr Row kRows[] = {
    {"actuator.seal_friction", Balance::kArmTorque, "arm_speed"},
    {"amp.bias", Balance::kPumpTorque, "motor_speed"},
    {"fluid.entrained_air", Balance::kFlow1, "p1 rate"},
    {"fluid.entrained_air", Balance::kFlow2, "p2 rate"},
    {"fluid.stiffening", Balance::kFlow1, "p1 rate"},
    {"fluid.stiffening", Balance::kFlow2, "p2 rate"},
    {"fluid.warming", Balance::kPumpTorque, "time"},
    {"motor.speed_torque_limit", Balance::kPumpTorque, "motor_speed"},
    {"pump.friction_asymmetry", Balance::kPumpTorque, "motor_speed"},
    {"pump.pressure_friction", Balance::kPumpTorque, "(p1 + p2) sgn(motor_speed)"},
    {"pump.quadratic_drag", Balance::kPumpTorque, "motor_speed"},
    {"pump.stribeck", Balance::kPumpTorque, "motor_speed"},
    {"pump.turbulent_leakage", Balance::kFlow1, "p2 - p1"},
    {"pump.turbulent_leakage", Balance::kFlow2, "p2 - p1"},
    {"valve.relief", Balance::kFlow1, "p1"},
    {"valve.relief", Balance::kFlow2, "p2"},
};

// Whole periods in a turn; 0 where the effect has none.
int PeriodsOf(const model::EffectDescription& effect) {
  const auto periods = effect.parameters.find("periods");
  return periods == effect.parameters.end() ? 0 : static_cast<int>(std::lround(periods->second));
}

}  // namespace

std::vector<OwnVariable> OwnVariables(const model::EffectDescription& effect) {
  std::vector<OwnVariable> own;
  for (const Row& row : kRows) {
    if (effect.id == row.effect) own.push_back({row.balance, row.variable});
  }
  const std::string periods = std::to_string(PeriodsOf(effect));
  if (effect.id == "motor.cogging") {
    own.push_back({Balance::kPumpTorque, "motor_angle, " + periods + " periods a turn"});
  }
  if (effect.id == "pump.flow_ripple") {
    own.push_back({Balance::kFlow1, "motor_speed cos(" + periods + " motor_angle)"});
    own.push_back({Balance::kPumpTorque, "(p2 - p1) cos(" + periods + " motor_angle)"});
  }
  return own;
}

}  // namespace hydro::diagnose
