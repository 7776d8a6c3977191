// Describes in words what a stack says of itself: why there is a fault or a run ended, and which voltage a
// plant or driver has left at the amplifier.
#pragma once

#include <algorithm>
#include <cmath>
#include <hydro/output_left_t.hpp>
#include <hydro/stop_t.hpp>
#include <string>
#include <string_view>

#include "base/number_text.h"

namespace hydro::bus {

// A reason as a person reads it. Whoever sent none, or blanks, is said to have given none.
inline std::string ReasonText(const std::string& reason, const char* otherwise = "no reason is given") {
  const bool blank =
      std::all_of(reason.begin(), reason.end(), [](unsigned char c) { return c <= ' ' || c == 0x7f; });
  return blank ? otherwise : reason;
}

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
