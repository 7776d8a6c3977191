// The form of the seal that may follow an encoded message (made and checked in bus/seal/). It is defined here
// because every reader must know where the message ends. LCM's encoding stays as it is, and LCM's own
// decoders do not look beyond a message's end.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace hydro::bus {

// magic | session i64 | counter u64 | keyed hash; the integers are big-endian.
inline constexpr std::array<uint8_t, 8> kSealMagic = {'h', 'y', 'd', 'r', 'o', 'M', 'A', 'C'};
inline constexpr int kSealTagSize = 16;
inline constexpr int kSealSize = 8 + 8 + 8 + kSealTagSize;

// The size of the message without its seal; `size` when it has none. Verifies nothing.
inline int SizeWithoutSeal(const void* data, int size) {
  if (size < kSealSize) return size;
  const uint8_t* const seal = static_cast<const uint8_t*>(data) + size - kSealSize;
  return std::memcmp(seal, kSealMagic.data(), kSealMagic.size()) == 0 ? size - kSealSize : size;
}

}  // namespace hydro::bus
