// The bus over UDP multicast on which the thread that calls HandleUntil() takes messages straight from the
// socket.
#pragma once

#include <memory>

#include "bus/udpm/udpm_bus.h"
#include "bus/udpm/udpm_socket.h"

namespace hydro::bus {

// For loops, which wait for nothing else: half the wake-ups of QueuedUdpmBus, and no allocation. Between
// calls, messages wait in the kernel's receive buffer.
class DirectUdpmBus : public UdpmBus {
 public:
  DirectUdpmBus(const UdpmUrl& url, std::unique_ptr<Authenticator> authenticator,
                ReceiveBuffer receive_buffer);

 private:
  int fd() const override { return socket_.fd(); }
  Outcome HandleNext() override;
  bool Send(const std::string& channel, const void* data, int size) override;
  void Listen(const std::string& channel) override { socket_.Accept(channel); }
  void ListenToAll() override { socket_.AcceptAll(); }

  UdpmSocket socket_;
};

}  // namespace hydro::bus
