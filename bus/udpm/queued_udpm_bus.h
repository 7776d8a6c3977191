// The bus over UDP multicast on which liblcm receives, on its own thread and into an unlimited queue.
#pragma once

#include <lcm/lcm.h>

#include <exception>
#include <memory>
#include <string>

#include "bus/udpm/udpm_bus.h"

namespace hydro::bus {

// For receivers that may be busy. Apply real-time scheduling (real_time.h) before construction: LCM's
// receiving thread inherits it.
class QueuedUdpmBus : public UdpmBus {
 public:
  // `lcm_url` in liblcm's form. Throws BusError when liblcm cannot work with it.
  QueuedUdpmBus(const std::string& lcm_url, std::unique_ptr<Authenticator> authenticator,
                ReceiveBuffer receive_buffer);
  ~QueuedUdpmBus() override;

 private:
  int fd() const override { return fd_; }
  Outcome HandleNext() override;
  bool Send(const std::string& channel, const void* data, int size) override;
  void Listen(const std::string& channel) override;
  void ListenToAll() override;

  void SubscribeLcm(const std::string& pattern);
  bool Waits() const;
  static void OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* bus) noexcept;

  lcm_t* lcm_ = nullptr;
  int fd_ = -1;
  // Of the message in hand. LCM delivers it once for each pattern that it matches.
  bool seen_ = false;
  Outcome outcome_ = Outcome::kPassedOver;
  std::exception_ptr exception_;  // thrown by a handler, kept until LCM's C code has returned
};

}  // namespace hydro::bus
