// The seal of an authenticated message: a trailer (seal_trailer.h) that names the sender (session), numbers
// its messages (counter), and proves both with a keyed hash over channel, session, counter and message.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "bus/seal_trailer.h"

namespace hydro::bus {

inline constexpr size_t kBusKeySize = 32;

struct Seal {
  int64_t session = 0;
  uint64_t counter = 0;
  std::array<uint8_t, kSealTagSize> tag{};
};

// The keyed hash (libsodium's BLAKE2b) over everything that a seal vouches for.
std::array<uint8_t, kSealTagSize> SealTag(const std::array<uint8_t, kBusKeySize>& key,
                                          std::string_view channel, int64_t session, uint64_t counter,
                                          const void* message, int size);

// Writes kSealSize bytes.
void WriteSeal(const Seal& seal, uint8_t* out);

// Reads the seal at the end of `data`; false when there is none. Verifies nothing.
bool ReadSeal(const void* data, int size, Seal* seal);

// Compares in constant time.
bool SameTag(const std::array<uint8_t, kSealTagSize>& a, const std::array<uint8_t, kSealTagSize>& b);

}  // namespace hydro::bus
