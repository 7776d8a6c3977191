// What a plant or driver has left at the amplifier, in words.
#pragma once

#include <cmath>
#include <hydro/output_left_t.hpp>
#include <string>

#include "base/number_text.h"

namespace hydro::process {

// "plant: the output reads back 0 V"
inline std::string OutputLeftText(const output_left_t& left) {
  const std::string what = left.accepted ? "" : "did NOT accept zero volts and ";
  return left.role.substr(0, 40) + ": the output " + what +
         (std::isnan(left.voltage) ? "cannot be read back"
                                   : "reads back " + ShortNumber(left.voltage, 3) + " V");
}

}  // namespace hydro::process
