#include "launch/doctor/multicast_route.h"

#include <arpa/inet.h>

#include <bit>
#include <cstdint>
#include <sstream>

namespace hydro::launch {
namespace {

// These values are from linux/route.h, which clashes with the C library's header.
constexpr uint32_t kUp = 1;
constexpr uint32_t kReject = 0x200;

// The kernel prints each address, which is in network byte order in memory, as a number in host byte order.
std::string Describe(uint32_t destination, uint32_t mask) {
  if (mask == 0) return "default";
  char text[INET_ADDRSTRLEN] = {};
  const in_addr address{destination};
  inet_ntop(AF_INET, &address, text, sizeof text);
  return std::string(text) + "/" + std::to_string(std::popcount(mask));
}

}  // namespace

std::optional<MulticastRoute> FindMulticastRoute(const std::string& routes, const std::string& group) {
  in_addr wanted{};
  if (inet_pton(AF_INET, group.c_str(), &wanted) != 1) return std::nullopt;
  std::optional<MulticastRoute> best;
  int best_length = -1;
  long best_metric = 0;
  std::istringstream lines(routes);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string interface;
    uint32_t destination = 0, gateway = 0, flags = 0, mask = 0;
    long references = 0, use = 0, metric = 0;
    fields >> interface >> std::hex >> destination >> gateway >> flags >> std::dec >> references >> use >>
        metric >> std::hex >> mask;
    if (!fields || (flags & kUp) == 0 || (wanted.s_addr & mask) != destination) continue;
    const int length = std::popcount(mask);
    if (length < best_length || (length == best_length && metric >= best_metric)) continue;
    best_length = length;
    best_metric = metric;
    best = (flags & kReject) != 0 ? MulticastRoute{} : MulticastRoute{interface, Describe(destination, mask)};
  }
  if (best && best->interface.empty()) return std::nullopt;
  return best;
}

}  // namespace hydro::launch
