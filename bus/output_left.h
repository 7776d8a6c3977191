// Describes in words how a run ended: why, and which voltage a plant or driver has left at the amplifier.
#pragma once

#include <cmath>
#include <hydro/output_left_t.hpp>
#include <hydro/stop_t.hpp>
#include <string>
#include <string_view>

#include "base/number_text.h"

namespace hydro::bus {

// The beginning of a stop's reason when the run has ended by itself, after its duration.
inline constexpr std::string_view kRunComplete = "the run is complete";

inline bool IsCompletion(const stop_t& stop) {
  return stop.exit_code == 0 && stop.reason.starts_with(kRunComplete);
}

// "plant: the output reads back 0 V"
inline std::string OutputLeftText(const output_left_t& left) {
  const std::string what = left.accepted ? "" : "did NOT accept zero volts and ";
  return left.role.substr(0, 40) + ": the output " + what +
         (std::isnan(left.voltage) ? "cannot be read back"
                                   : "reads back " + ShortNumber(left.voltage, 3) + " V");
}

}  // namespace hydro::bus
