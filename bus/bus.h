// The seam between an application and the world: typed messages on named channels.
//
// An application takes a Bus and a Clock (clock.h), never a socket. The same application runs over LCM UDP multicast
// (udpm_bus.h), inside one process on a simulated clock (in_process_bus.h) and on a recorded log (log_bus.h).
//
// Contract, the same for every transport:
// - Messages on one channel from one sender arrive in the order they were sent.
// - Handlers run only inside HandleUntil(), on the thread that calls it, one at a time. What a handler publishes is
//   delivered by a later turn of the same or a later HandleUntil(), never inside Publish().
// - An exception thrown by a handler leaves HandleUntil() (it never travels through C code).
// - A message that cannot be decoded (another type, truncated) is counted in undecodable() and not delivered.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hydro {

// The bus cannot work here (no multicast route, bad URL, a self test that failed). what() says what to do about it.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How to copy, encode and decode one message type without knowing it.
struct MessageType {
  int64_t hash;
  int (*encoded_size)(const void* message);
  int (*encode)(const void* message, void* buffer, int capacity);
  std::shared_ptr<void> (*decode)(const void* data, int size);  // null: not a message of this type
};

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
        return message->decode(data, 0, size) == size ? message : nullptr;
      }};
  return type;
}

// A message as it crosses the wire or lies in a log. The bytes live only as long as the handler's call.
struct RawMessage {
  std::string_view channel;
  const uint8_t* data = nullptr;
  int size = 0;
  int64_t receive_utime = 0;  // us since 1970-01-01 UTC, or simulated time, when it was received
};

class Bus {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;  // of the Clock that belongs to this bus

  virtual ~Bus() = default;
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Sends `message` on `channel`. Throws BusError when the transport refuses it.
  template <class Message>
  void Publish(const std::string& channel, const Message& message) {
    PublishTyped(channel, TypeOf<Message>(), &message);
  }

  // Calls `handler` for each message on exactly `channel`. Subscriptions last as long as the bus.
  template <class Message>
  void Subscribe(const std::string& channel, std::function<void(const Message&)> handler) {
    SubscribeTyped(channel, TypeOf<Message>(), [handler = std::move(handler)](const void* message) {
      handler(*static_cast<const Message*>(message));
    });
  }

  // Calls `handler` with the encoded form of every message on every channel, in order of arrival.
  virtual void SubscribeAll(std::function<void(const RawMessage&)> handler) = 0;

  // Sends bytes that are encoded already (replay, relay).
  virtual void PublishRaw(const std::string& channel, const void* data, int size) = 0;

  // Handles messages until at least one was handled (then all that are waiting) or `deadline` has passed.
  // Returns how many were handled; 0 means that the deadline passed. A bus on a simulated clock returns at once when
  // nothing is waiting, having advanced that clock to the deadline.
  virtual int HandleUntil(TimePoint deadline) = 0;

  // Messages that arrived on a subscribed channel and could not be decoded as its type.
  virtual int64_t undecodable() const = 0;

 protected:
  virtual void PublishTyped(const std::string& channel, const MessageType& type, const void* message) = 0;
  virtual void SubscribeTyped(const std::string& channel, const MessageType& type,
                              std::function<void(const void*)> handler) = 0;
};

}  // namespace hydro
