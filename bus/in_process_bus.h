// The bus within one process: no sockets, no threads, and no encoding unless there is a subscriber to the
// encoded messages.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::bus {

// Dispatches messages in the order of publication, across all channels. Drops a message that has no
// subscriber. SubscribeAll() handlers see a message before the typed ones do.
class InProcessBus : public Bus {
 public:
  // HandleUntil() advances `clock`, which also stamps what SubscribeAll() sees. Null: wall time, and
  // HandleUntil() sleeps until the deadline when nothing is waiting.
  explicit InProcessBus(SimulatedClock* clock);
  ~InProcessBus() override;

  void SubscribeAll(std::function<void(const RawMessage&)> handler) override;
  void PublishRaw(const std::string& channel, const void* data, int size) override;

  // Handles the messages waiting at the call. What handlers publish meanwhile waits for the next call.
  int HandleUntil(TimePoint deadline) override;
  int64_t undecodable() const override { return undecodable_; }

 protected:
  void PublishTyped(const std::string& channel, const MessageType& type, const void* message) override;
  void SubscribeTyped(const std::string& channel, const MessageType& type,
                      std::function<void(const void*)> handler) override;
  std::shared_ptr<Outlet> MakeOutlet(const std::string& channel, const MessageType& type) override;

 private:
  struct Channel;
  class ChannelOutlet;

  Channel& Find(const std::string& name);
  void Enqueue(Channel& channel, const MessageType& type, const void* message);
  void Order(Channel* channel);
  void Dispatch(Channel& channel);

  SimulatedClock* clock_;
  int64_t undecodable_ = 0;
  bool handling_ = false;
  std::unordered_map<std::string, std::unique_ptr<Channel>> channels_;
  std::array<Channel*, 16> recent_{};  // by the address of the caller's name, whose text is then compared
  std::deque<std::function<void(const RawMessage&)>> taps_;
  std::vector<uint8_t> encoded_;  // reused for each message
  // Ring of the channels of the waiting messages, oldest first; its size is a power of 2.
  std::vector<Channel*> order_;
  size_t first_ = 0;  // index of the oldest; counts on, the position is modulo the size
  size_t end_ = 0;    // one past the newest
};

}  // namespace hydro::bus
