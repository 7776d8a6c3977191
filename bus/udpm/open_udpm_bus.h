// Opens the bus over LCM UDP multicast, over which separate processes talk.
#pragma once

#include <memory>
#include <string>

#include "bus/udpm/udpm_bus.h"

namespace hydro::bus {

// The receive buffer asked of the kernel when the URL names none: no loss up to 150,000 messages/s.
inline constexpr int kReceiveBufferBytes = 4 << 20;

// Who takes messages from the network.
enum class Receiving {
  kQueued,  // a thread of LCM's: QueuedUdpmBus
  kDirect,  // the thread that calls HandleUntil(): DirectUdpmBus
};

// `url` as in udpm_url.h, or "memq://" (queued, and private to the object). Proves that multicast works
// before it returns. Throws InputError for a bad URL, and BusError with the cure where multicast does not
// work. With an `authenticator`, messages on its channels are sealed, and only genuine ones are delivered.
//
// Nothing is dropped here: the queue is unlimited, and the receive buffer asked of the kernel is large.
std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url,
                                     std::unique_ptr<Authenticator> authenticator = nullptr,
                                     Receiving receiving = Receiving::kQueued);

}  // namespace hydro::bus
