// Makes the kernel drop packets on channels without a subscriber here, before they wake the process.
#pragma once

#include <string>
#include <vector>

namespace hydro::bus {

// Makes the UDP socket `fd` pass LCM packets (lcm_packet.h) on exactly these channels, and all fragments. If
// the kernel refuses the filter, all packets arrive.
void AttachChannelFilter(int fd, const std::vector<std::string>& channels);

}  // namespace hydro::bus
