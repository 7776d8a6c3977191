#include "tools/hydro_log/record_gap.h"

#include <algorithm>

#include "base/integers.h"

namespace hydro::hydro_log {

std::optional<int64_t> FirstMissingState(const std::map<int64_t, state_t>& states) {
  std::optional<int64_t> expected;
  for (const auto& [tick, state] : states) {
    const int64_t skipped = std::max<int64_t>(state.skipped_ticks, 0);
    if (expected && SaturatingDifference(tick, *expected) > skipped) return expected;
    expected = SaturatingSum(tick, 1);
  }
  return std::nullopt;
}

std::optional<int64_t> FirstWithoutPressureCommand(
    const std::map<int64_t, motor_command_t>& commands,
    const std::map<int64_t, pressure_command_t>& pressure_commands) {
  for (const auto& [tick, command] : commands) {
    if (command.pressure_command_tick >= 0 && !pressure_commands.contains(command.pressure_command_tick)) {
      return tick;
    }
  }
  return std::nullopt;
}

}  // namespace hydro::hydro_log
