#include "bus/udpm/direct_udpm_bus.h"

#include <utility>

namespace hydro::bus {

DirectUdpmBus::DirectUdpmBus(const UdpmUrl& url, std::unique_ptr<Authenticator> authenticator,
                             ReceiveBuffer receive_buffer)
    : UdpmBus(std::move(authenticator), receive_buffer), socket_(url) {}

UdpmBus::Outcome DirectUdpmBus::HandleNext() {
  UdpmSocket::Message message;
  if (!socket_.Receive(&message)) return Outcome::kNoneWaited;
  return Deliver({message.channel, message.data, static_cast<int>(message.size), message.receive_utime});
}

bool DirectUdpmBus::Send(const std::string& channel, const void* data, int size) {
  return socket_.Send(channel, data, static_cast<size_t>(size));
}

}  // namespace hydro::bus
