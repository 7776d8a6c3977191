// The seam between an application and the world: typed messages on named channels.
//
// An application takes a Bus and a Clock (clock.h), never a socket. The same application runs over LCM UDP
// multicast (udpm/open_udpm_bus.h), inside one process on a simulated clock (in_process_bus.h) and on a
// recorded log, which hydro-log replay plays into an InProcessBus.
//
// Every transport keeps this contract (tests/bus/bus_contract_test.cc):
// - Messages from one sender on one channel arrive in the order in which they were sent.
// - Handlers run only inside HandleUntil(), on the thread that calls it, one at a time. What a handler
//   publishes is delivered in a later turn of the same HandleUntil() or in a later call, never inside
//   Publish().
// - An exception thrown by a handler leaves HandleUntil() (it never passes through C code).
// - A message that cannot be decoded (another type, truncated) is counted in undecodable() and not delivered.
// - A message is never delivered with its seal (bus/seal/). On a bus with a key, a message that is not
//   genuine is counted in refused() and not delivered.
// - A handler may subscribe, also to its own channel: the new handler gets later messages, not this one.
// - Only one thread uses a bus.
#pragma once

#include <chrono>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "bus/seal_trailer.h"

namespace hydro::bus {

// The identity of a simulated process, and the signal sent to it, where many of them share one real process
// (sim/torture/).
struct HostedProcess {
  std::string host;
  int32_t id = 0;       // its process id
  int64_t session = 0;  // its identity on the bus; never 0
  int stop_signal = 0;  // SIGINT, SIGTERM or SIGHUP, once one has been sent to it
};

// Thrown when the bus cannot work here: no multicast route, a bad URL, a failed self-test. what() says what
// to do about it.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How to copy, encode and decode a message type that is not known at compile time.
struct MessageType {
  int64_t hash;
  int (*encoded_size)(const void* message);
  int (*encode)(const void* message, void* buffer, int capacity);
  std::shared_ptr<void> (*decode)(const void* data, int size);  // null: not a message of this type
  std::shared_ptr<void> (*create)();                            // a message with unspecified fields
  void (*copy)(void* to, const void* from);
  bool (*decode_into)(void* message, const void* data, int size);  // false: not a message of this type
};

// Returns true when decoding consumed all `size` bytes, except for a seal.
inline bool DecodedAll(int decoded, const void* data, int size) {
  return decoded == size || (decoded >= 0 && decoded == SizeWithoutSeal(data, size));
}

// Whether a message that was decoded from another process can be sent on. LCM's strings end at the first zero
// byte, and a changed or made-up message may have one anywhere. Only messages with strings can fail.
template <class Message>
bool CanBeEncoded(const Message& message) {
  if constexpr (std::is_trivially_copyable_v<Message>) return true;
  const int size = message.getEncodedSize();
  thread_local std::vector<uint8_t> bytes;  // loops take no memory
  bytes.resize(static_cast<size_t>(size));
  return message.encode(bytes.data(), 0, size) == size;
}

// Decodes all `size` bytes. Returns false when they are not a message of this type.
template <class Message>
bool DecodeInto(Message* message, const void* data, int size) {
  return DecodedAll(message->decode(data, 0, size), data, size) && CanBeEncoded(*message);
}

template <class Message>
const MessageType& TypeOf() {
  static const MessageType type{
      Message::getHash(),
      [](const void* m) { return static_cast<const Message*>(m)->getEncodedSize(); },
      [](const void* m, void* buffer, int capacity) {
        return static_cast<const Message*>(m)->encode(buffer, 0, capacity);
      },
      [](const void* data, int size) -> std::shared_ptr<void> {
        auto message = std::make_shared<Message>();
        return DecodeInto(message.get(), data, size) ? message : nullptr;
      },
      []() -> std::shared_ptr<void> { return std::make_shared<Message>(); },
      [](void* to, const void* from) {
        CopyFresh(static_cast<Message*>(to), *static_cast<const Message*>(from));
      },
      [](void* message, const void* data, int size) {
        return DecodeInto(static_cast<Message*>(message), data, size);
      }};
  return type;
}

// A message as it is sent over the network or stored in a log. Its bytes are valid only while the handler
// runs.
struct RawMessage {
  std::string_view channel;
  const uint8_t* data = nullptr;
  int size = 0;
  int64_t receive_utime = 0;  // us since 1970-01-01 UTC, or simulated time, when it was received
};

// Counts of messages refused on authenticated channels, by reason.
struct RefusedMessages {
  int64_t unsealed = 0;        // without a seal: the sender has no key
  int64_t wrong_seal = 0;      // the sender has another key, or the message changed on the way
  int64_t repeated = 0;        // no newer than one already accepted: replayed or overtaken
  int64_t unknown_sender = 0;  // genuine, but its sender does not answer: a recording of an earlier run
  std::string last_channel;

  int64_t total() const { return unsealed + wrong_seal + repeated + unknown_sender; }
};

// A channel that the bus has already looked up, for messages of one type. A Publisher sends through it.
class Outlet {
 public:
  virtual ~Outlet() = default;
  Outlet() = default;
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;
  virtual void Send(const void* message) = 0;
};

// The fast way to send many messages on one channel (Bus::Advertise). Copies send on the same channel. Must
// not outlive its bus.
template <class Message>
class Publisher {
 public:
  explicit Publisher(std::shared_ptr<Outlet> outlet) : outlet_(std::move(outlet)) {}

  // Like Bus::Publish() on the advertised channel.
  void Send(const Message& message) { outlet_->Send(&message); }

 private:
  std::shared_ptr<Outlet> outlet_;
};

class Bus {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;  // of this bus's Clock

  virtual ~Bus() = default;
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Sends `message` on `channel`. Throws BusError when the transport refuses it. While the network is down (a
  // cable, an interface), messages are lost without an error: see unsent().
  template <class Message>
  void Publish(const std::string& channel, const Message& message) {
    PublishTyped(channel, TypeOf<Message>(), &message);
  }

  // Looks up `channel` once, for messages sent in every cycle: advertise in the constructor, Send() in the
  // loop.
  template <class Message>
  Publisher<Message> Advertise(const std::string& channel) {
    return Publisher<Message>(MakeOutlet(channel, TypeOf<Message>()));
  }

  // Calls `handler` for each message on exactly this channel. A subscription lasts as long as the bus.
  template <class Message, std::invocable<const Message&> Handler>
  void Subscribe(const std::string& channel, Handler handler) {
    SubscribeTyped(channel, TypeOf<Message>(), [handler = std::move(handler)](const void* message) mutable {
      handler(*static_cast<const Message*>(message));
    });
  }

  // Calls `handler` with every encoded message on every channel, in order of arrival.
  virtual void SubscribeAll(std::function<void(const RawMessage&)> handler) = 0;

  // Sends bytes that are already encoded (replay, relay).
  virtual void PublishRaw(const std::string& channel, const void* data, int size) = 0;

  // Waits until `deadline` for a message, then handles it and all others that are waiting. Returns how many
  // it handled. 0 means that the deadline passed or a signal arrived, so a loop that ends on SIGINT checks
  // its flag after each call. A bus on a simulated clock never waits: with no message pending, it advances
  // the clock to the deadline and returns. A handler must not call this (std::logic_error).
  virtual int HandleUntil(TimePoint deadline) = 0;

  // From now on HandleUntil() also returns, with 0 or more, while `descriptor` (-1: none) has something to
  // read. Transports without sockets wait for messages alone.
  virtual void WakeOn(int /*descriptor*/) {}

  // The number of messages that arrived on a subscribed channel but could not be decoded as its type.
  int64_t undecodable() const { return undecodable_; }

  // The number of messages that could not be sent because the network was down.
  int64_t unsent() const { return unsent_; }

  // The simulated process to which this bus belongs; null: the real process that runs this code.
  const HostedProcess* process() const { return process_; }

  // The channel of the newest message that could not be decoded; empty when there was none or the transport
  // does not know.
  const std::string& undecodable_channel() const { return undecodable_channel_; }

  // The counts of messages that were not genuine. Always zero on a bus without a key.
  const RefusedMessages& refused() const { return *refused_; }

 protected:
  virtual void PublishTyped(const std::string& channel, const MessageType& type, const void* message) = 0;
  virtual void SubscribeTyped(const std::string& channel, const MessageType& type,
                              std::function<void(const void*)> handler) = 0;

  // Makes the outlet for Advertise(); by default it calls PublishTyped() on `channel`.
  virtual std::shared_ptr<Outlet> MakeOutlet(const std::string& channel, const MessageType& type) {
    return std::make_shared<NamedOutlet>(this, channel, type);
  }

  // The transport's counters and identity; loops read them at every turn.
  int64_t undecodable_ = 0;
  int64_t unsent_ = 0;
  const RefusedMessages* refused_ = &NoneRefused();
  const HostedProcess* process_ = nullptr;
  std::string undecodable_channel_;

 private:
  static const RefusedMessages& NoneRefused() {
    static const RefusedMessages kNone;
    return kNone;
  }

  class NamedOutlet : public Outlet {
   public:
    NamedOutlet(Bus* bus, std::string channel, const MessageType& type)
        : bus_(bus), channel_(std::move(channel)), type_(type) {}
    void Send(const void* message) override { bus_->PublishTyped(channel_, type_, message); }

   private:
    Bus* bus_;
    std::string channel_;
    const MessageType& type_;
  };
};

}  // namespace hydro::bus
