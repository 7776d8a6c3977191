// The key that the processes of a stack share (bus.key_file).
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "bus/seal/message_seal.h"

namespace hydro::bus {

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
