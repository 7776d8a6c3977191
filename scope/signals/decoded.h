// Decodes a message of foreign bytes.
#pragma once

#include <cstdint>
#include <stdexcept>

#include "bus/bus.h"

namespace hydro::scope {

// False: `data` is no whole message of that type.
//
// Through the type's function rather than its class: LCM 1.3.1 writes doubles as 64-bit integers, and where GCC inlines that
// beside code that reads the doubles, it may read them first (-fstrict-aliasing).
template <class Message>
bool Decoded(Message* message, const uint8_t* data, int size) {
  try {
    return bus::TypeOf<Message>().decode_into(message, data, size);
  } catch (const std::length_error&) {  // lcm-gen's code believes a string length of 0 or less
    return false;
  }
}

}  // namespace hydro::scope
