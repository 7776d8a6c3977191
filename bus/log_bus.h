// The bus of a replay: an application receives the messages of a log, and the messages that it publishes are
// compared with the log.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::bus {

// Handles events in the order of the log. What the application publishes does not come back as a message.
class LogBus : public Bus {
 public:
  // Fills in the next event; its receive_utime is the log's timestamp. Its bytes and channel must stay valid
  // until the next call. Returns false when the log has ended.
  using EventSource = std::function<bool(RawMessage*)>;

  struct Options {
    // The bus advances this clock to each event's timestamp before it handles the event, from the first event
    // on. Null: wall time.
    SimulatedClock* clock = nullptr;
    // Seconds of the log per second of wall time; 0: as fast as possible. With `clock` it must be 0.
    double speed = 0;
    // Called with each message that the application publishes. Empty: publications are dropped.
    std::function<void(const std::string& channel, const MessageType& type, const void* message)> published =
        {};
    std::function<void(const std::string& channel, const void* data, int size)> published_raw = {};
  };

  // Throws std::invalid_argument for a speed that is negative or does not fit the clock.
  LogBus(EventSource source, Options options);

  // True when every event has been handled or skipped; HandleUntil() then only returns 0.
  bool at_end() const { return !has_next_; }

  void SubscribeAll(std::function<void(const RawMessage&)> handler) override;
  void PublishRaw(const std::string& channel, const void* data, int size) override;

  // Handles the next event that has a subscriber and returns 1. It handles only one, so that the application
  // can act in between. Returns 0 when that event lies beyond `deadline`, at the end of the log, or at a
  // signal.
  int HandleUntil(TimePoint deadline) override;

 protected:
  void PublishTyped(const std::string& channel, const MessageType& type, const void* message) override;
  void SubscribeTyped(const std::string& channel, const MessageType& type,
                      std::function<void(const void*)> handler) override;

 private:
  struct Handler {
    std::string channel;
    const MessageType* type;
    std::shared_ptr<void> message;  // receives the decoded message
    std::function<void(const void*)> call;
  };

  void ReadNext();
  TimePoint DueTime() const;
  bool WaitUntil(TimePoint time);
  bool Dispatch(const RawMessage& event);

  EventSource source_;
  Options options_;
  RawMessage next_;
  bool has_next_ = false;
  bool handling_ = false;
  TimePoint wall_start_;  // when the first event is due
  int64_t first_utime_ = 0;
  std::deque<Handler> handlers_;  // a handler may subscribe: existing ones stay in place
  std::deque<std::function<void(const RawMessage&)>> taps_;
};

}  // namespace hydro::bus
