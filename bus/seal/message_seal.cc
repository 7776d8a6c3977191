#include "bus/seal/message_seal.h"

#include <sodium.h>

#include <cstring>
#include <string>

#include "base/big_endian.h"

namespace hydro::bus {
namespace {

static_assert(kSealTagSize >= static_cast<int>(crypto_generichash_BYTES_MIN));
static_assert(kBusKeySize >= crypto_generichash_KEYBYTES_MIN &&
              kBusKeySize <= crypto_generichash_KEYBYTES_MAX);

constexpr std::string_view kPurpose =
    "hydro message seal 1";  // separates this use of the key from all its other uses

const uint8_t* Bytes(std::string_view text) { return reinterpret_cast<const uint8_t*>(text.data()); }

}  // namespace

std::array<uint8_t, kSealTagSize> SealTag(const std::array<uint8_t, kBusKeySize>& key,
                                          std::string_view channel, int64_t session, uint64_t counter,
                                          const void* message, int size) {
  // The lengths come first, so that no two different inputs give the same bytes.
  std::array<uint8_t, 32> numbers{};
  StoreBigEndian64(channel.size(), numbers.data());
  StoreBigEndian64(static_cast<uint64_t>(size), numbers.data() + 8);
  StoreBigEndian64(static_cast<uint64_t>(session), numbers.data() + 16);
  StoreBigEndian64(counter, numbers.data() + 24);

  std::array<uint8_t, kSealTagSize> tag{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.data(), key.size(), tag.size());
  crypto_generichash_update(&state, Bytes(kPurpose), kPurpose.size());
  crypto_generichash_update(&state, numbers.data(), numbers.size());
  crypto_generichash_update(&state, Bytes(channel), channel.size());
  crypto_generichash_update(&state, static_cast<const uint8_t*>(message), static_cast<size_t>(size));
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

void WriteSeal(const Seal& seal, uint8_t* out) {
  std::memcpy(out, kSealMagic.data(), kSealMagic.size());
  StoreBigEndian64(static_cast<uint64_t>(seal.session), out + 8);
  StoreBigEndian64(seal.counter, out + 16);
  std::memcpy(out + 24, seal.tag.data(), seal.tag.size());
}

bool ReadSeal(const void* data, int size, Seal* seal) {
  const int message_size = SizeWithoutSeal(data, size);
  if (message_size == size) return false;
  const uint8_t* const in = static_cast<const uint8_t*>(data) + message_size;
  seal->session = static_cast<int64_t>(LoadBigEndian64(in + 8));
  seal->counter = LoadBigEndian64(in + 16);
  std::memcpy(seal->tag.data(), in + 24, seal->tag.size());
  return true;
}

bool SameTag(const std::array<uint8_t, kSealTagSize>& a, const std::array<uint8_t, kSealTagSize>& b) {
  return sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace hydro::bus
