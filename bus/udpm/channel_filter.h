// Makes the kernel drop packets on channels that nobody here subscribes to before they wake the process.
#pragma once

#include <string>
#include <vector>

namespace hydro::bus {

// Makes the UDP socket `fd` pass LCM packets (lcm_packet.h) of exactly these channels, and all fragments.
// Where the kernel refuses the filter, everything arrives.
void AttachChannelFilter(int fd, const std::vector<std::string>& channels);

}  // namespace hydro::bus
