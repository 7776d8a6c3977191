// The bus over LCM's UDP multicast: encoding, seals, subscriptions and delivery. The thread that calls
// HandleUntil() takes messages straight from the socket; between calls they wait in the kernel's buffer.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/seal/authenticator.h"
#include "bus/udpm/udpm_socket.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

class UdpmBus : public Bus {
 public:
  // The kernel's receive buffer in bytes: the requested size and the one that it granted (which includes the
  // kernel's own bookkeeping).
  struct ReceiveBuffer {
    int asked = 0;
    int given = 0;
  };

  // OpenUdpmBus() (open_udpm_bus.h) makes one, after it has proved that multicast works. Throws BusError.
  UdpmBus(const UdpmUrl& url, std::unique_ptr<Authenticator> authenticator, ReceiveBuffer receive_buffer);

  // Does not deliver the messages by which LCM tests itself when a process starts. Refused messages come as
  // they arrived, with REFUSED_ before the channel's name.
  void SubscribeAll(std::function<void(const RawMessage&)> handler) override;
  void PublishRaw(const std::string& channel, const void* data, int size) override;

  // Returns 0 early when a signal arrives. Handles at most 4096 messages per call, so that a flood cannot
  // trap it.
  int HandleUntil(TimePoint deadline) override;
  void WakeOn(int descriptor) override { wake_on_ = descriptor; }

  int receive_buffer_bytes() const { return receive_buffer_.given; }

  // One line on how to allow a larger receive buffer; empty when it is large enough.
  std::string receive_buffer_hint() const;

 protected:
  void PublishTyped(const std::string& channel, const MessageType& type, const void* message) override;
  void SubscribeTyped(const std::string& channel, const MessageType& type,
                      std::function<void(const void*)> handler) override;

 private:
  struct Subscription {
    std::string channel;            // of a typed one
    const MessageType* type;        // null: to all channels
    std::shared_ptr<void> message;  // decoded into, reused for each message
    std::function<void(const void*)> typed;
    std::function<void(const RawMessage&)> raw;
  };

  // A genuine message: it is delivered to SubscribeAll() handlers as soon as its sender has proved itself.
  struct HeldMessage {
    std::string channel;
    std::vector<uint8_t> data;
    int64_t receive_utime;
    int64_t session;
    TimePoint arrived;
  };

  // What became of a waiting message.
  enum class Outcome { kNoneWaited, kHandled, kPassedOver };

  // Takes one waiting message and passes it to Deliver(). Never waits for one.
  Outcome HandleNext();

  // If an arrived message is genuine, calls its handlers in the order of subscription. Call it once for each
  // message. An exception of a handler passes through.
  Outcome Deliver(const RawMessage& arrived);

  bool DeliverTyped(const RawMessage& message, Subscription* subscription);
  void SendOrCount(const std::string& channel, const void* data, int size);

  // These are defined in udpm_authentication.cc.
  void StartIntroductions();
  std::optional<int> Authenticate(const RawMessage& arrived);
  void Ask(int64_t session, TimePoint now);
  void Record(const RawMessage& message);
  void RecordRefused(const RawMessage& arrived);
  void RecordHeld(int64_t session);
  void GiveUpHeld();

  std::unique_ptr<Authenticator> authenticator_;  // null: without a key
  ReceiveBuffer receive_buffer_;
  UdpmSocket socket_;
  std::deque<Subscription> subscriptions_;  // a handler may subscribe: existing ones stay in place
  std::vector<uint8_t> encoded_;            // reused for each message
  bool handling_ = false;
  int wake_on_ = -1;

  bool introduced_ = false;
  std::deque<HeldMessage> held_;
};

}  // namespace hydro::bus
