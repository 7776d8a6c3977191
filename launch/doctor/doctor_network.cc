#include <arpa/inet.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <sstream>

#include "launch/doctor/doctor.h"

namespace hydro::launch {
namespace {

const NetworkInterface* Find(const MachineFacts& facts, const std::string& name) {
  const auto found = std::find_if(facts.interfaces.begin(), facts.interfaces.end(),
                                  [&](const NetworkInterface& candidate) { return candidate.name == name; });
  return found == facts.interfaces.end() ? nullptr : &*found;
}

// The interface that most likely leads to the other hosts; one that is down when none is up.
std::string WayOut(const MachineFacts& facts, bool* up) {
  for (const bool wanted : {true, false}) {
    for (const NetworkInterface& candidate : facts.interfaces) {
      if (candidate.loopback || candidate.up != wanted) continue;
      *up = wanted;
      return candidate.name;
    }
  }
  *up = false;
  return "";
}

std::string RouteCure(const DoctorTask& task, const MachineFacts& facts, const std::string& destination) {
  if (task.url.ttl == 0) {
    const NetworkInterface* loopback = Find(facts, "lo");
    const bool down = loopback != nullptr && !loopback->up;
    return std::string(down ? "ip link set lo up && " : "") + "ip route replace " + destination + " dev lo";
  }
  bool up = false;
  const std::string interface = WayOut(facts, &up);
  if (interface.empty()) return "ip link  # shows no interface but the loopback: connect one";
  return (up ? "" : "ip link set " + interface + " up && ") + "ip route replace " + destination + " dev " +
         interface;
}

Finding RouteFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "multicast route";
  const std::string& group = task.url.group;
  const auto route = FindMulticastRoute(facts.routes, group);
  if (!route) {
    if (facts.self_test_error.empty()) return {kCheck, true, "in a routing table other than main", ""};
    return {kCheck, false, "there is no route to " + group, RouteCure(task, facts, "224.0.0.0/4")};
  }
  const NetworkInterface* interface = Find(facts, route->interface);
  const std::string found =
      fmt::format("{} goes to {} ({})", group, route->interface,
                  route->destination == "default" ? "the default route" : route->destination);
  if (interface != nullptr && !interface->up) {
    return {kCheck, false, found + ", which is down", "ip link set " + route->interface + " up"};
  }
  if (task.url.ttl > 0 && interface != nullptr && interface->loopback) {
    return {kCheck, false,
            found + fmt::format(", but with ttl={} other hosts should hear the stack", task.url.ttl),
            RouteCure(task, facts, route->destination == "default" ? "224.0.0.0/4" : route->destination)};
  }
  if (interface != nullptr && !interface->loopback && !interface->multicast) {
    return {kCheck, false, found + ", on which multicast is switched off",
            "ip link set " + route->interface + " multicast on"};
  }
  return {kCheck, true, found, ""};
}

std::string FirewallCure(const DoctorTask& task, const MachineFacts& facts) {
  const std::string& group = task.url.group;
  const int port = task.url.port;
  if (facts.firewall == "ufw") return fmt::format("ufw allow proto udp to {} port {}", group, port);
  if (facts.firewall == "firewall-cmd") return fmt::format("firewall-cmd --add-port={}/udp", port);
  if (facts.firewall == "nft") {
    return fmt::format("nft insert rule inet filter input ip daddr {} udp dport {} accept", group, port);
  }
  return fmt::format(
      "iptables -I INPUT -p udp -d {0} --dport {1} -j ACCEPT && iptables -I OUTPUT -p udp -d {0} --dport {1} "
      "-j ACCEPT",
      group, port);
}

Finding SelfTestFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "loopback delivery";
  if (facts.self_test_error.empty()) {
    return {kCheck, true, fmt::format("a packet sent to {}:{} came back", task.url.group, task.url.port), ""};
  }
  // The bus's message ends with its own cure, which this line removes.
  const std::string found = facts.self_test_error.substr(0, facts.self_test_error.find("; "));
  if (found.find("route") != found.npos || found.find("cannot join") != found.npos ||
      found.find("unreachable") != found.npos) {
    const Finding route = RouteFinding(task, facts);
    return {kCheck, false, found, route.ok ? RouteCure(task, facts, "224.0.0.0/4") : route.cure};
  }
  if (found.find("listen on the port") != found.npos) {
    return {
        kCheck, false, found,
        fmt::format(
            "ss -ulpn 'sport = :{}'  # shows which process holds it: end it, or set another port in bus.url",
            task.url.port)};
  }
  return {kCheck, false, found, FirewallCure(task, facts)};
}

Finding BufferFinding(const MachineFacts& facts) {
  constexpr char kCheck[] = "kernel buffers";
  const int given = facts.receive_buffer_bytes;
  const int asked = facts.receive_buffer_asked;
  if (given >= asked) return {kCheck, true, fmt::format("{} bytes for each receiver", asked), ""};
  return {kCheck, false,
          fmt::format("{} bytes for each receiver, allowed are {} or more: bursts may lose messages", given,
                      asked),
          fmt::format(
              "sysctl -w net.core.rmem_max={0} && echo net.core.rmem_max={0} > /etc/sysctl.d/60-hydro.conf",
              asked)};
}

std::string Joined(const HeardStack& stack) {
  return fmt::format("{}{}", fmt::join(stack.processes, ", "),
                     stack.suffix.empty() ? "" : " (suffix " + stack.suffix + ")");
}

Finding NeighbourFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "other stacks";
  if (facts.listened_s <= 0) return {kCheck, true, "could not listen: see above", ""};
  std::vector<std::string> others;
  for (const HeardStack& stack : facts.stacks) {
    const auto joint = std::find(task.joint_suffixes.begin(), task.joint_suffixes.end(), stack.suffix);
    if (stack.suffix != task.channel_suffix && joint == task.joint_suffixes.end()) {
      others.push_back(Joined(stack));
      continue;
    }
    const std::string config = task.config.empty() ? "CONFIG" : task.config;
    return {kCheck, false,
            fmt::format("a stack runs on port {} with the same channels: {}", task.url.port, Joined(stack)),
            fmt::format("hydro-launch {} --stop  # or give this one another port in bus.url", config)};
  }
  std::string found = fmt::format("none with these channels on port {}", task.url.port);
  if (!others.empty()) found += fmt::format("; with others: {}", fmt::join(others, "; "));
  if (facts.other_messages > 0) {
    found += fmt::format("; other programs send {:.0f} messages a second there",
                         static_cast<double>(facts.other_messages) / facts.listened_s);
  }
  return {kCheck, true, found, ""};
}

// A bridge is a switch inside this machine; switches outside cannot be queried (docs/network.md).
Finding SnoopingFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "IGMP snooping";
  const auto route = FindMulticastRoute(facts.routes, task.url.group);
  const NetworkInterface* interface = route ? Find(facts, route->interface) : nullptr;
  if (task.url.ttl == 0) return {kCheck, true, "does not matter: ttl=0 stays on this machine", ""};
  if (interface == nullptr || !interface->snooping) {
    return {kCheck, true, "no bridge on this machine; for switches outside it see docs/network.md", ""};
  }
  if (!*interface->snooping || interface->querier.value_or(false)) {
    return {kCheck, true, "the bridge " + interface->name + " forwards the group", ""};
  }
  return {kCheck, false,
          "the bridge " + interface->name +
              " snoops without a querier: it stops forwarding the group after some minutes",
          "ip link set " + interface->name + " type bridge mcast_querier 1"};
}

Finding ReachFinding(const DoctorTask& task) {
  constexpr char kCheck[] = "ttl and hosts";
  if (task.several_hosts && task.url.ttl == 0) {
    bus::UdpmUrl far = task.url;
    far.ttl = 1;
    return {kCheck, false, "[[process]] names several hosts, but with ttl=0 no packet leaves its host",
            fmt::format("sed -i 's|^ *url *=.*|url = \"{}\"|' {}", far.ToString(), task.config)};
  }
  if (task.open_network) {
    return {
        kCheck, false,
        fmt::format("ttl={} and no bus.key_file: anyone on the network can command the motor", task.url.ttl),
        fmt::format("sed -i '/^\\[bus\\]/a key_file = \"bus.key\"' {0} && hydro-launch {0} --make-key  # "
                    "and copy the key "
                    "to the other hosts: docs/security.md",
                    task.config)};
  }
  return {kCheck, true,
          task.url.ttl == 0 ? "this machine alone (ttl=0)" : fmt::format("ttl={}", task.url.ttl), ""};
}

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

std::vector<Finding> DiagnoseNetwork(const DoctorTask& task, const MachineFacts& facts) {
  return {RouteFinding(task, facts), SelfTestFinding(task, facts), BufferFinding(facts),
          ReachFinding(task),        SnoopingFinding(task, facts), NeighbourFinding(task, facts)};
}

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
