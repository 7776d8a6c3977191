// Through which interface a multicast group leaves the machine.
#pragma once

#include <optional>
#include <string>

namespace hydro::launch {

struct MulticastRoute {
  std::string interface;
  std::string destination;  // e.g. 224.0.0.0/4; default
};

// The most specific route to `group` (IPv4, dotted) in the text of /proc/net/route; nothing where there is
// none or it refuses.
std::optional<MulticastRoute> FindMulticastRoute(const std::string& routes, const std::string& group);

}  // namespace hydro::launch
