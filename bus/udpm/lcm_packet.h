// The format of LCM's UDP multicast packets, as LCM 1.x defines it (udpm_socket.h sends and receives them):
//   whole message   "LC02" | sequence number u32 | channel, 0 | data
//   fragment        "LC03" | sequence number u32 | size of the data u32 | offset u32 | number u16
//                   | number of fragments u16 | in fragment 0: channel, 0 | data
// with all integers big-endian.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hydro::bus {

constexpr uint32_t kLcmWholeMagic = 0x4c433032;
constexpr uint32_t kLcmFragmentMagic = 0x4c433033;
constexpr size_t kLcmWholeHeader = 8;
constexpr size_t kLcmFragmentHeader = 20;
constexpr size_t kLcmLargestWhole = 65499;     // bytes of channel, its 0 and data
constexpr size_t kLcmLargestFragment = 65487;  // bytes after the header
constexpr size_t kLcmLargestPacket = 65507;    // UDP's own limit
constexpr size_t kLcmLongestChannel = 63;

// A number of up to 4 bytes, as a packet holds it.
inline uint32_t LoadLcm(const uint8_t* bytes, size_t size) {
  uint32_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

// The 0 that ends the channel at `channel`; null when there is none before `end` or within the longest name.
inline const uint8_t* EndOfLcmChannel(const uint8_t* channel, const uint8_t* end) {
  const auto most = static_cast<ptrdiff_t>(kLcmLongestChannel + 1);
  const uint8_t* const last = end - channel > most ? channel + most : end;
  const uint8_t* const zero = std::find(channel, last, uint8_t{0});
  return zero == last ? nullptr : zero;
}

// The parts of a whole message, within its packet.
struct LcmWhole {
  const char* channel = nullptr;
  const uint8_t* data = nullptr;
  size_t size = 0;
};

// Returns false when `packet` is not a whole message.
inline bool ReadLcmWhole(const uint8_t* packet, size_t size, LcmWhole* whole) {
  if (size < kLcmWholeHeader || LoadLcm(packet, 4) != kLcmWholeMagic) return false;
  const uint8_t* const channel = packet + kLcmWholeHeader;
  const uint8_t* const zero = EndOfLcmChannel(channel, packet + size);
  if (zero == nullptr) return false;
  *whole = {reinterpret_cast<const char*>(channel), zero + 1,
            static_cast<size_t>(packet + size - (zero + 1))};
  return true;
}

}  // namespace hydro::bus
