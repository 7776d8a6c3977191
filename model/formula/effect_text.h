// An effect written as text: its formulas as its file has them, and its entry for the catalogue.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model/formula/names.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

// A state that the effect adds.
struct StateText {
  std::string name;
  std::string unit;
  std::string rate;   // "(k_1 * voltage - lagged) / tau"
  std::string start;  // "0" where empty
  // The size below which absolute rather than relative errors count: "pressure", "flow", "torque", "arm",
  // "angle", "speed", "voltage" (the model's sizes), or a number in the state's unit.
  std::string scale = "0.001";
  std::string is;  // "p_3" or "actuator_angle" where it takes that quantity's place
};

// A switch that the effect adds. Its positions are whole numbers from -100 to 100, and formulas read its
// position by its name.
struct SwitchText {
  std::string name;
  std::string margin;             // positive while the position may stay, falls through 0 when it must change
  std::string next;               // the position after a change
  std::string start;              // that of a run that begins in motion; "" where the margins find it from 0
  std::vector<std::string> sets;  // states that jump at a change: "arm_speed = 0"
};

struct EffectText {
  // Statements. Each acts where the quantity that it changes becomes known.
  std::vector<std::string> equation;
  // Statements with an explicit hook.
  std::vector<std::pair<Hook, std::vector<std::string>>> equations;
  std::vector<std::pair<std::string, std::string>> where;  // name, what it stands for
  std::vector<StateText> states;
  std::vector<SwitchText> switches;
  std::string fixed_volume;                 // of each side outside the actuator
  std::string stored, dissipated, viscous;  // power, see Power
  bool replaces_valves = false;
};

// The key of each hook that can have its own statements: "equations.torques_and_flows".
const std::vector<std::pair<std::string, Hook>>& EquationKeys();

// A formula of an effect cannot work. Holds the key in the file, and the message without the key.
class EffectTextError : public std::runtime_error {
 public:
  EffectTextError(std::string key, const std::string& what)
      : std::runtime_error(what), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

}  // namespace hydro::model
