// The seal of an authenticated message: a trailer after the encoded message that says who sent it (session),
// the how manieth of that sender's messages it is (counter), and proves it with a keyed hash over channel,
// session, counter and message. What LCM encodes stays as it is: LCM's own decoders do not look beyond a
// message's end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace hydro::bus {

// magic | session i64 | counter u64 | keyed hash, integers big-endian.
inline constexpr std::array<uint8_t, 8> kSealMagic = {'h', 'y', 'd', 'r', 'o', 'M', 'A', 'C'};
inline constexpr int kSealTagSize = 16;
inline constexpr int kSealSize = 8 + 8 + 8 + kSealTagSize;

inline constexpr size_t kBusKeySize = 32;

struct Seal {
  int64_t session = 0;
  uint64_t counter = 0;
  std::array<uint8_t, kSealTagSize> tag{};
};

// Size of the message without its seal; `size` where there is none. Nothing is verified.
inline int SizeWithoutSeal(const void* data, int size) {
  if (size < kSealSize) return size;
  const uint8_t* const seal = static_cast<const uint8_t*>(data) + size - kSealSize;
  return std::memcmp(seal, kSealMagic.data(), kSealMagic.size()) == 0 ? size - kSealSize : size;
}

// The keyed hash (BLAKE2b of libsodium) over everything that a seal vouches for.
std::array<uint8_t, kSealTagSize> SealTag(const std::array<uint8_t, kBusKeySize>& key,
                                          std::string_view channel, int64_t session, uint64_t counter,
                                          const void* message, int size);

// Writes kSealSize bytes.
void WriteSeal(const Seal& seal, uint8_t* out);

// Reads the seal at the end of `data`; false: there is none. Nothing is verified.
bool ReadSeal(const void* data, int size, Seal* seal);

// In constant time.
bool SameTag(const std::array<uint8_t, kSealTagSize>& a, const std::array<uint8_t, kSealTagSize>& b);

}  // namespace hydro::bus
