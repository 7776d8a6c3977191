// Tests whether multicast works here. LCM itself finds out too late: it blocks for ten seconds, then aborts
// the process.
#pragma once

#include <chrono>

#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

// Sends a packet to the group and port of `url` and waits for it to come back, as another process on this
// machine would receive it. Returns the receive buffer that the kernel grants when asked for
// `url.recv_buf_size`. Throws BusError with the cause and its cure: no route, a firewall, a port in use.
int TestMulticast(const UdpmUrl& url, std::chrono::milliseconds timeout = std::chrono::milliseconds(2000));

}  // namespace hydro::bus
