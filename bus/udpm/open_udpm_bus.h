// Opens the bus over LCM UDP multicast: what separate processes talk over.
#pragma once

#include <memory>
#include <string>

#include "bus/udpm/udpm_bus.h"

namespace hydro::bus {

// Asked of the kernel for a receiver's buffer where the URL says nothing: none lost up to 150,000 messages/s.
inline constexpr int kReceiveBufferBytes = 4 << 20;

// Who takes messages from the network.
enum class Receiving {
  kQueued,  // a thread of LCM's: QueuedUdpmBus
  kDirect,  // the thread that calls HandleUntil(): DirectUdpmBus
};

// `url` as in udpm_url.h, or "memq://" (queued, and private to the object). Proves that multicast works
// before it returns. Throws InputError for a bad URL and BusError, with the cure, where multicast does not
// work. With an `authenticator` the messages on its channels are sealed, and only genuine ones are delivered.
//
// Nothing is dropped here: a queue is unlimited, and the kernel's receive buffer is asked to be large.
std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url,
                                     std::unique_ptr<Authenticator> authenticator = nullptr,
                                     Receiving receiving = Receiving::kQueued);

}  // namespace hydro::bus
