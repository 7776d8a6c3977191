// Every fault that a process of the stack can raise, and its effect on the voltage. docs/faults.md explains
// the faults, and process/safety lists when they occur; tests keep both and this list in step.
#pragma once

#include <span>
#include <string_view>

namespace hydro::process {

enum class FaultEffect {
  kZeroVolts,  // at once
  kRamp,       // the pressure reference goes to zero first (limits.pressure_ramp_s)
  kWarning,    // control goes on
};

struct FaultCode {
  std::string_view code;
  FaultEffect effect;
};

std::span<const FaultCode> FaultCodes();

// True unless `code` is known not to zero the voltage at once; an unknown code counts as one that does.
bool ZeroesVoltage(std::string_view code);

// Like ZeroesVoltage(), but also true for a fault that zeroes the voltage in the end, by ramping the
// reference to zero.
bool LeadsToZeroVolts(std::string_view code);

// True when `code` is known to be a warning only.
bool IsWarning(std::string_view code);

}  // namespace hydro::process
