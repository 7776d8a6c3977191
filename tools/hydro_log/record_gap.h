// Finds where a record lacks what a controller was given. From there on, a replay proves nothing.
#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

#include "hydro/motor_command_t.hpp"
#include "hydro/pressure_command_t.hpp"
#include "hydro/state_t.hpp"

namespace hydro::hydro_log {

// The first tick after the first state that has no state and that the plant did not skip.
std::optional<int64_t> FirstMissingState(const std::map<int64_t, state_t>& states);

// The first tick whose motor command follows from a pressure command that the log lacks.
std::optional<int64_t> FirstWithoutPressureCommand(
    const std::map<int64_t, motor_command_t>& commands,
    const std::map<int64_t, pressure_command_t>& pressure_commands);

// Removes the commands from tick `gap` on from the comparison and returns their number.
template <class Commands>
int64_t CutAt(const std::optional<int64_t>& gap, Commands& commands) {
  if (!gap) return 0;
  const auto from = commands.lower_bound(*gap);
  const auto count = std::distance(from, commands.end());
  commands.erase(from, commands.end());
  return count;
}

}  // namespace hydro::hydro_log
