// The format of LCM's UDP multicast packets, as LCM 1.x defines it (udpm_socket.h sends and receives them):
//   whole message   "LC02" | sequence number u32 | channel, 0 | data
//   fragment        "LC03" | sequence number u32 | size of the data u32 | offset u32 | number u16
//                   | number of fragments u16 | in fragment 0: channel, 0 | data
// with all integers big-endian.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

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

// Reassembles messages that LCM split into several packets.
//
// Memory is bounded: messages have at most 16 MiB, at most four are incomplete at a time (a new one replaces
// the oldest), and they take no more memory than the received packets took.
class FragmentAssembly {
 public:
  struct Message {
    std::string channel;
    std::vector<uint8_t> data;
  };

  // Takes a fragment, as a whole packet, from a sender. Returns the message when this was its last missing
  // piece. Ignores a packet that is not a valid fragment.
  std::optional<Message> Take(uint64_t sender, const uint8_t* packet, size_t size);

 private:
  struct Piece {
    size_t offset = 0;
    std::vector<uint8_t> data;
    bool have = false;
  };
  struct Unfinished {
    uint64_t sender = 0;
    uint32_t sequence = 0;
    size_t size = 0;  // of all the data
    std::string channel;
    std::vector<Piece> pieces;
  };
  static std::optional<Message> Joined(const Unfinished& whole);

  std::deque<Unfinished> unfinished_;
};

// Makes the UDP socket `fd` pass LCM packets on exactly these channels, and all fragments. The kernel drops
// the others before they wake the process; if it refuses the filter, all packets arrive.
void AttachChannelFilter(int fd, const std::vector<std::string>& channels);

}  // namespace hydro::bus
