#include "bus/udpm/open_udpm_bus.h"

#include <algorithm>
#include <utility>

#include "bus/udpm/direct_udpm_bus.h"
#include "bus/udpm/multicast_self_test.h"
#include "bus/udpm/queued_udpm_bus.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url, std::unique_ptr<Authenticator> authenticator,
                                     Receiving receiving) {
  if (url == "memq://") {
    return std::make_unique<QueuedUdpmBus>(url, std::move(authenticator), UdpmBus::ReceiveBuffer());
  }
  UdpmUrl parsed = ParseUdpmUrl(url);
  if (parsed.recv_buf_size == 0) parsed.recv_buf_size = kReceiveBufferBytes;
  const UdpmBus::ReceiveBuffer buffer{parsed.recv_buf_size, TestMulticast(parsed)};
  // LCM prints several lines when it gets less than it asks for, so we ask for what we know it will get.
  parsed.recv_buf_size = std::min(buffer.asked, buffer.given);
  if (receiving == Receiving::kDirect) {
    return std::make_unique<DirectUdpmBus>(parsed, std::move(authenticator), buffer);
  }
  return std::make_unique<QueuedUdpmBus>(parsed.ToString(), std::move(authenticator), buffer);
}

}  // namespace hydro::bus
