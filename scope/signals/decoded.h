// Decodes a message whose bytes come from outside this program.
#pragma once

#include <cstdint>
#include <stdexcept>

#include "bus/bus.h"

namespace hydro::scope {

// Returns false when `data` is not a whole message of that type.
//
// This calls the type's function rather than its class: LCM 1.3.1 writes doubles as 64-bit integers, and
// where GCC inlines that code beside code that reads the doubles, it may read them first (-fstrict-aliasing).
template <class Message>
bool Decoded(Message* message, const uint8_t* data, int size) {
  try {
    return bus::TypeOf<Message>().decode_into(message, data, size);
  } catch (const std::length_error&) {  // the code from lcm-gen trusts a string length of 0 or less
    return false;
  }
}

}  // namespace hydro::scope
