#include "model/formula/names.h"

#include <algorithm>
#include <utility>

namespace hydro::model {

const std::vector<FieldName>& FieldNames() {
  static const std::vector<FieldName> names = {
      {"voltage", Hook::kProperties, Hook::kStates},
      {"torque", Hook::kProperties, Hook::kTorquesAndFlows},
      {"D", Hook::kProperties, Hook::kTorquesAndFlows},
      {"b", Hook::kProperties, Hook::kBalances},
      {"T_s", Hook::kProperties, Hook::kProperties},
      {"f", Hook::kProperties, Hook::kProperties},
      {"beta_1", Hook::kProperties, Hook::kStates},
      {"beta_2", Hook::kProperties, Hook::kStates},
      {"c_E", Hook::kProperties, Hook::kProperties},
      {"c_I", Hook::kProperties, Hook::kProperties},
      {"p_3", Hook::kProperties, Hook::kProperties},
      {"pump_p1", Hook::kProperties, Hook::kProperties},
      {"pump_p2", Hook::kProperties, Hook::kProperties},
      {"V_1", Hook::kProperties, Hook::kStates},
      {"V_2", Hook::kProperties, Hook::kStates},
      {"actuator_speed", Hook::kProperties, Hook::kStates},
      {"c_1", Hook::kProperties, Hook::kStates},
      {"c_2", Hook::kProperties, Hook::kStates},
      {"pressure_torque", Hook::kProperties, Hook::kProperties},
      {"shaft_angle", Hook::kProperties, Hook::kProperties},
      {"shaft_load", Hook::kTorquesAndFlows, Hook::kTorquesAndFlows},
      {"load", Hook::kTorquesAndFlows, Hook::kStates},
      {"coulomb", Hook::kTorquesAndFlows, Hook::kBalances},
      {"breakaway", Hook::kTorquesAndFlows, Hook::kBalances},
      {"cross_flow", Hook::kTorquesAndFlows, Hook::kTorquesAndFlows},
      {"outer_flow_1", Hook::kTorquesAndFlows, Hook::kTorquesAndFlows},
      {"outer_flow_2", Hook::kTorquesAndFlows, Hook::kTorquesAndFlows},
      {"valve_flow_1", Hook::kTorquesAndFlows, Hook::kStates},
      {"valve_flow_2", Hook::kTorquesAndFlows, Hook::kStates},
      {"arm_torque", Hook::kTorquesAndFlows, Hook::kBalances},
      {"net_torque", Hook::kStates, Hook::kBalances},
      {"q_1", Hook::kStates, Hook::kStates},
      {"q_2", Hook::kStates, Hook::kStates},
      {"free_rate_1", Hook::kBalances, Hook::kBalances},
      {"free_rate_2", Hook::kBalances, Hook::kBalances},
      {"p_3_rate", Hook::kBalances, Hook::kBalances},
      {"torque_asked", Hook::kTorquesAndFlows, Hook::kStates},
      {"voltage_asked", Hook::kProperties, Hook::kStates},
      {"arm_load", Hook::kStates, Hook::kStates},
      {"motor_angle", Hook::kProperties, Hook::kProperties},
      {"motor_speed", Hook::kProperties, Hook::kProperties},
      {"arm_angle", Hook::kProperties, Hook::kProperties},
      {"arm_speed", Hook::kProperties, Hook::kProperties},
      {"p1", Hook::kProperties, Hook::kProperties},
      {"p2", Hook::kProperties, Hook::kProperties},
  };
  return names;
}

const std::vector<std::string>& ReadingNames() {
  static const std::vector<std::string> names = {"measured_motor_angle", "measured_motor_speed",
                                                 "measured_arm_angle",   "measured_arm_speed",
                                                 "measured_p1",          "measured_p2"};
  return names;
}

const std::vector<std::string>& FactNames() {
  static const std::vector<std::string> names = {"direction",    "arm_free",     "bypass",
                                                 "valve_1_open", "valve_2_open", "temperature"};
  return names;
}

const std::vector<std::string>& StartNames() {
  static const std::vector<std::string> names = {"wave_pressure_1", "wave_flow_1", "wave_pressure_2",
                                                 "wave_flow_2", "returned"};
  return names;
}

std::string FullName(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> aliases = {
      {"theta", "motor_angle"}, {"theta'", "motor_speed"}, {"alpha", "arm_angle"}, {"alpha'", "arm_speed"},
      {"v", "voltage"},         {"T_p", "torque"},         {"p3", "p_3"}};
  const auto found =
      std::find_if(aliases.begin(), aliases.end(), [&](const auto& alias) { return alias.first == name; });
  return found == aliases.end() ? name : found->second;
}

std::optional<size_t> PlaceOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<size_t>(found - names.begin());
}

std::optional<size_t> FieldPlace(const std::string& name) {
  const std::vector<FieldName>& fields = FieldNames();
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const FieldName& field) { return field.name == name; });
  if (found == fields.end()) return std::nullopt;
  return static_cast<size_t>(found - fields.begin());
}

}  // namespace hydro::model
