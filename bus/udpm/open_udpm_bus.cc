#include "bus/udpm/open_udpm_bus.h"

#include <utility>

#include "bus/udpm/multicast_self_test.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url, std::unique_ptr<Authenticator> authenticator) {
  UdpmUrl parsed = ParseUdpmUrl(url);
  if (parsed.recv_buf_size == 0) parsed.recv_buf_size = kReceiveBufferBytes;
  const UdpmBus::ReceiveBuffer buffer{parsed.recv_buf_size, TestMulticast(parsed)};
  return std::make_unique<UdpmBus>(parsed, std::move(authenticator), buffer);
}

}  // namespace hydro::bus
