// The bus over UDP multicast whose messages are taken from the socket by the thread that calls HandleUntil(),
// as they come.
#pragma once

#include <memory>

#include "bus/udpm/udpm_bus.h"
#include "bus/udpm/udpm_socket.h"

namespace hydro::bus {

// For loops, which wait for nothing else: half the wake-ups of QueuedUdpmBus, and no allocation. What comes
// meanwhile waits in the kernel's receive buffer.
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
