// The messages that make up a run: what hydro-log compare and replay use.
#pragma once

#include <vector>

#include "hydro/arm_reference_t.hpp"
#include "hydro/fault_t.hpp"
#include "hydro/motor_command_t.hpp"
#include "hydro/pressure_command_t.hpp"
#include "hydro/state_t.hpp"

namespace hydro::runs {

struct RunMessages {
  std::vector<state_t> states;
  std::vector<motor_command_t> motor_commands;
  std::vector<pressure_command_t> pressure_commands;
  std::vector<arm_reference_t> arm_references;
  std::vector<fault_t> faults;
};

}  // namespace hydro::runs
