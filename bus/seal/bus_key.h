// The key of a bus, and the seal of an authenticated message.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "bus/seal_trailer.h"

namespace hydro::bus {

inline constexpr size_t kBusKeySize = 32;

// The seal of an authenticated message: a trailer (seal_trailer.h) that names the sender (session), numbers
// its messages (counter), and proves both with a keyed hash over channel, session, counter and message.
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

// The key that the processes of a stack share (bus.key_file).

// A key whose memory is wiped on destruction.
class BusKey {
 public:
  explicit BusKey(const std::array<uint8_t, kBusKeySize>& bytes) : bytes_(bytes) {}
  ~BusKey();
  BusKey(const BusKey&) = default;
  BusKey& operator=(const BusKey&) = default;

  const std::array<uint8_t, kBusKeySize>& bytes() const { return bytes_; }

 private:
  std::array<uint8_t, kBusKeySize> bytes_;
};

// The key of the stack on that port: a hash of `key` and port, so that messages of one stack are of no use on
// another that has the same key file. (The channel suffix is sealed with each message.)
BusKey KeyForPort(const BusKey& key, int port);

// Reads a key file: 32 bytes, as 64 hexadecimal digits or in base64, on one line. Throws InputError naming
// the file when it cannot be read, holds anything else, or is accessible to anyone but its owner. The error
// never shows the content.
BusKey ReadBusKey(const std::string& file);

// Writes a new random key, readable by its owner only. Throws InputError when the file exists or cannot be
// created.
void MakeBusKeyFile(const std::string& file);

}  // namespace hydro::bus
