// Every fault that a process of the stack can name, and what it does to the voltage. docs/safety.md explains
// them; a test keeps the two together.
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

// True unless `code` is known to leave the voltage alone at first: what is not known is not taken lightly.
bool ZeroesVoltage(std::string_view code);

// True when `code` is known to be a warning only.
bool IsWarning(std::string_view code);

}  // namespace hydro::process
