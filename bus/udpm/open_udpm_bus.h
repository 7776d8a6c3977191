// Opens the bus over LCM UDP multicast, through which separate processes communicate.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "bus/udpm/udpm_bus.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

// Tests whether multicast works here. LCM itself finds out too late: it blocks for ten seconds, then aborts
// the process.
//
// Sends a packet to the group and port of `url` and waits for it to come back, as another process on this
// machine would receive it. Returns the receive buffer that the kernel grants when asked for
// `url.recv_buf_size`. Throws BusError with the cause and its cure: no route, a firewall, a port in use.
int TestMulticast(const UdpmUrl& url, std::chrono::milliseconds timeout = std::chrono::milliseconds(2000));

// The receive buffer requested from the kernel when the URL names none: no loss up to 150,000 messages/s.
inline constexpr int kReceiveBufferBytes = 4 << 20;

// `url` is as in udpm_url.h. Proves that multicast works before it returns. Throws InputError for a bad URL,
// and BusError with the cure when multicast does not work. With an `authenticator`, messages on its channels
// are sealed, and only genuine ones are delivered.
//
// Nothing is dropped here: the receive buffer requested from the kernel is large, and a program that may be
// busy for longer than the buffer lasts has a queue of its own (logger/event_queue.h).
std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url,
                                     std::unique_ptr<Authenticator> authenticator = nullptr);

}  // namespace hydro::bus
