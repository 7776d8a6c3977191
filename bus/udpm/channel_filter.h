// Has the kernel drop packets of channels that nobody here listens to, before they wake the process.
#pragma once

#include <string>
#include <vector>

namespace hydro::bus {

// Lets through LCM packets (lcm_packet.h) of exactly these channels, and all fragments, at the UDP socket
// `fd`. Does nothing where the kernel refuses: then more arrives than is wanted.
void AttachChannelFilter(int fd, const std::vector<std::string>& channels);

}  // namespace hydro::bus
