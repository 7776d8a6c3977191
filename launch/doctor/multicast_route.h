// Finds the interface through which a multicast group leaves the machine.
#pragma once

#include <optional>
#include <string>

namespace hydro::launch {

struct MulticastRoute {
  std::string interface;
  std::string destination;  // e.g. 224.0.0.0/4; default
};

// The most specific route to `group` (IPv4, dotted) in the text of /proc/net/route; nothing when there is
// none or it rejects packets.
std::optional<MulticastRoute> FindMulticastRoute(const std::string& routes, const std::string& group);

}  // namespace hydro::launch
