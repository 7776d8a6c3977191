// The bus over LCM UDP multicast: what separate processes talk over.
#pragma once

#include <lcm/lcm.h>

#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/seal/authenticator.h"
#include "bus/udpm/udpm_socket.h"

namespace hydro::bus {

// Asked of the kernel for a receiver's buffer where the URL says nothing: none lost up to 150,000 messages/s.
inline constexpr int kReceiveBufferBytes = 4 << 20;

// Who takes messages from the network.
enum class Receiving {
  // A thread of LCM's, into a queue without limit: for who may be busy with something else for long.
  kQueued,
  // The thread that calls HandleUntil(), as they come (udpm_socket.h): for loops, which wait for nothing
  // else.
  // Half the wake-ups, no allocation; what comes meanwhile waits in the kernel's receive buffer.
  kDirect,
};

// Apply real-time scheduling (real_time.h) before constructing it: LCM's receiving thread inherits it.
// Nothing is dropped here: a queue is unlimited, and the kernel's receive buffer is asked to be large.
class UdpmBus : public Bus {
 public:
  // `url` as in udpm_url.h, or "memq://" (private to this object). Proves that multicast works before it
  // returns. Throws InputError for a bad URL and BusError, with the cure, where multicast does not work.
  // With an `authenticator` the messages on its channels are sealed, and only genuine ones are delivered.
  explicit UdpmBus(const std::string& url, std::unique_ptr<Authenticator> authenticator = nullptr,
                   Receiving receiving = Receiving::kQueued);
  ~UdpmBus() override;

  // Does not pass on the messages by which LCM tests itself when a process starts. Those that were refused
  // come as they arrived, on their channel with REFUSED_ before its name.
  void SubscribeAll(std::function<void(const RawMessage&)> handler) override;
  void PublishRaw(const std::string& channel, const void* data, int size) override;

  // Returns 0 early when a signal arrives. Handles at most 4096 messages a call, so that a flood cannot hold
  // it.
  int HandleUntil(TimePoint deadline) override;
  int64_t undecodable() const override { return undecodable_; }
  int64_t unsent() const override { return unsent_; }
  const RefusedMessages& refused() const override {
    return authenticator_ != nullptr ? authenticator_->refused() : Bus::refused();
  }

  // Bytes of receive buffer that the kernel gave (it counts its own bookkeeping as well); 0 for memq.
  int receive_buffer_bytes() const { return receive_buffer_bytes_; }

  // One line on how to allow a larger receive buffer; empty when it is large enough.
  std::string receive_buffer_hint() const;

 protected:
  void PublishTyped(const std::string& channel, const MessageType& type, const void* message) override;
  void SubscribeTyped(const std::string& channel, const MessageType& type,
                      std::function<void(const void*)> handler) override;

 private:
  struct Subscription {
    UdpmBus* bus;
    std::string channel;                // of a typed one
    const MessageType* type = nullptr;  // null: raw
    std::shared_ptr<void> message;      // what is decoded into, used again for each message
    std::function<void(const void*)> typed;
    std::function<void(const RawMessage&)> raw;
    bool own =
        false;  // typed: LCM calls it itself, because it was there before the subscription to all channels
  };

  // Genuine, for a SubscribeAll() handler, as soon as its sender has proved itself.
  struct HeldMessage {
    std::string channel;
    std::vector<uint8_t> data;
    int64_t receive_utime;
    int64_t session;
    TimePoint arrived;
  };

  static void OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* subscription) noexcept;
  void Deliver(const lcm_recv_buf_t& buffer, const char* channel, Subscription* subscription);
  void DeliverTyped(const RawMessage& message, Subscription* subscription);
  void AddSubscription(const std::string& pattern, Subscription* subscription);
  bool HandleNext();
  void Dispatch(const UdpmSocket::Message& message);
  void Send(const std::string& channel, const void* data, int size);

  // udpm_authentication.cc
  void StartIntroductions();
  std::optional<int> Authenticate(const RawMessage& arrived);
  void Ask(int64_t session, TimePoint now);
  void Record(const RawMessage& message);
  void RecordRefused(const RawMessage& arrived);
  void RecordHeld(int64_t session);
  void GiveUpHeld();

  std::unique_ptr<UdpmSocket> socket_;  // of a direct one; else lcm_
  lcm_t* lcm_ = nullptr;
  int fd_ = -1;
  int receive_buffer_bytes_ = 0;
  int receive_buffer_asked_ = 0;
  int64_t undecodable_ = 0;
  int64_t unsent_ = 0;
  bool handling_ = false;
  bool delivered_ = false;        // the message in hand reached a handler
  std::exception_ptr exception_;  // thrown by a handler, kept until LCM's C code is off the stack
  std::deque<Subscription> subscriptions_;
  Subscription* all_ = nullptr;   // the one that LCM knows as ".*"
  std::vector<uint8_t> encoded_;  // used again for each message

  std::unique_ptr<Authenticator> authenticator_;  // null: without a key
  bool introduced_ = false;
  std::deque<HeldMessage> held_;
  bool opened_ = false;            // the message in hand has been looked at
  std::optional<int> plain_size_;  // and what of it may be delivered
};

}  // namespace hydro::bus
