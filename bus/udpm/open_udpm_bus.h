// Opens the bus over LCM UDP multicast, over which separate processes talk.
#pragma once

#include <memory>
#include <string>

#include "bus/udpm/udpm_bus.h"

namespace hydro::bus {

// The receive buffer asked of the kernel when the URL names none: no loss up to 150,000 messages/s.
inline constexpr int kReceiveBufferBytes = 4 << 20;

// `url` as in udpm_url.h. Proves that multicast works before it returns. Throws InputError for a bad URL, and BusError with the cure where multicast does not
// work. With an `authenticator`, messages on its channels are sealed, and only genuine ones are delivered.
//
// Nothing is dropped here: the receive buffer asked of the kernel is large, and who may be busy for longer
// than it lasts has a queue of its own (logger/event_queue.h).
std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url,
                                     std::unique_ptr<Authenticator> authenticator = nullptr);

}  // namespace hydro::bus
