// The identity of a simulated process, and the signal sent to it, where many of them share one real process
// (sim/torture/).
#pragma once

#include <cstdint>
#include <string>

namespace hydro::bus {

struct HostedProcess {
  std::string host;
  int32_t id = 0;       // its process id
  int64_t session = 0;  // its identity on the bus; never 0
  int stop_signal = 0;  // SIGINT, SIGTERM or SIGHUP, once one has been sent to it
};

}  // namespace hydro::bus
