// The form of LCM's UDP multicast packets (udpm_socket.h sends and receives them), as LCM 1.x defines it:
//   whole message   "LC02" | sequence number u32 | channel, 0 | data
//   fragment        "LC03" | sequence number u32 | size of the data u32 | offset u32 | number u16 | of how
//   many u16 |
//                   in number 0: channel, 0 | data
// with all integers big-endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hydro {

constexpr uint32_t kLcmWholeMagic = 0x4c433032;
constexpr uint32_t kLcmFragmentMagic = 0x4c433033;
constexpr size_t kLcmWholeHeader = 8;
constexpr size_t kLcmFragmentHeader = 20;
constexpr size_t kLcmLargestWhole = 65499;     // bytes of channel, its 0 and data
constexpr size_t kLcmLargestFragment = 65487;  // bytes after the header
constexpr size_t kLcmLargestPacket = 65507;    // UDP's own limit
constexpr size_t kLcmLongestChannel = 63;

}  // namespace hydro
