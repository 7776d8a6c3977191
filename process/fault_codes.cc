#include "process/fault_codes.h"

#include <algorithm>
#include <array>

namespace hydro::process {
namespace {

constexpr std::array kCodes{
    // Pressure loop.
    FaultCode{"nonfinite_state", FaultEffect::kZeroVolts},
    FaultCode{"stale_state", FaultEffect::kZeroVolts},
    FaultCode{kSecondSender<state_t>, FaultEffect::kZeroVolts},
    FaultCode{"stale_pressure_command", FaultEffect::kRamp},
    FaultCode{"nonfinite_pressure_command", FaultEffect::kZeroVolts},
    FaultCode{"excessive_pressure_command", FaultEffect::kZeroVolts},
    FaultCode{"future_pressure_command", FaultEffect::kZeroVolts},
    FaultCode{kSecondSender<pressure_command_t>, FaultEffect::kZeroVolts},
    // Position loop.
    FaultCode{"nonfinite_arm_angle", FaultEffect::kZeroVolts},
    FaultCode{"refused_arm_plan", FaultEffect::kWarning},
    FaultCode{"silent_planner", FaultEffect::kWarning},
    // Pressure loop and plant or driver.
    FaultCode{"pressure_limit", FaultEffect::kZeroVolts},
    FaultCode{"motor_speed_limit", FaultEffect::kZeroVolts},
    FaultCode{"arm_angle_limit", FaultEffect::kZeroVolts},
    FaultCode{"nonfinite_motor_command", FaultEffect::kZeroVolts},
    // Plant or driver.
    FaultCode{"excessive_motor_command", FaultEffect::kZeroVolts},
    FaultCode{"future_motor_command", FaultEffect::kZeroVolts},
    FaultCode{"stale_motor_command", FaultEffect::kZeroVolts},
    FaultCode{kSecondSender<motor_command_t>, FaultEffect::kZeroVolts},
    FaultCode{"other_stack", FaultEffect::kZeroVolts},
    FaultCode{"late_plant", FaultEffect::kZeroVolts},
    FaultCode{"supervisor_gone", FaultEffect::kZeroVolts},
    FaultCode{"other_joint", FaultEffect::kZeroVolts},
    FaultCode{"joint_gone", FaultEffect::kZeroVolts},
    FaultCode{"machine_suspended", FaultEffect::kZeroVolts},
    FaultCode{"controller_fault", FaultEffect::kZeroVolts},
    FaultCode{"rig_fault", FaultEffect::kZeroVolts},
    FaultCode{"sensor_p1", FaultEffect::kZeroVolts},
    FaultCode{"sensor_p2", FaultEffect::kZeroVolts},
    FaultCode{"sensor_motor_angle", FaultEffect::kZeroVolts},
    FaultCode{"sensor_motor_speed", FaultEffect::kZeroVolts},
    FaultCode{"sensor_arm_angle", FaultEffect::kZeroVolts},
    FaultCode{"sensor_arm_speed", FaultEffect::kZeroVolts},
    FaultCode{"board_error", FaultEffect::kZeroVolts},
    FaultCode{"encoder_lost", FaultEffect::kZeroVolts},
    FaultCode{"device_silent", FaultEffect::kZeroVolts},
    FaultCode{"device_fault", FaultEffect::kZeroVolts},
    FaultCode{"output_differs", FaultEffect::kZeroVolts},
    FaultCode{"guardian_gone", FaultEffect::kZeroVolts},
    FaultCode{"model_error", FaultEffect::kZeroVolts},
    FaultCode{"repeated_motor_command", FaultEffect::kWarning},
    FaultCode{"logger_gone", FaultEffect::kWarning},
    // Logger.
    FaultCode{"log_overflow", FaultEffect::kWarning},
    // Any process.
    FaultCode{"undecodable_message", FaultEffect::kWarning},
    FaultCode{"unsent_message", FaultEffect::kWarning},
    FaultCode{"unauthenticated_command", FaultEffect::kWarning},
    FaultCode{"other_configuration", FaultEffect::kWarning},
};

}  // namespace

std::span<const FaultCode> FaultCodes() { return kCodes; }

bool ZeroesVoltage(std::string_view code) {
  for (const FaultCode& known : kCodes) {
    if (known.code == code) return known.effect == FaultEffect::kZeroVolts;
  }
  return true;
}

bool LeadsToZeroVolts(std::string_view code) { return !IsWarning(code); }

bool IsWarning(std::string_view code) {
  return std::any_of(kCodes.begin(), kCodes.end(), [&](const FaultCode& known) {
    return known.code == code && known.effect == FaultEffect::kWarning;
  });
}

}  // namespace hydro::process
