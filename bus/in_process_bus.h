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
  // HandleUntil() advances `clock`, which also stamps the messages that SubscribeAll() shows. Null: the bus
  // uses wall time, and HandleUntil() sleeps until the deadline when no message waits.
  explicit InProcessBus(SimulatedClock* clock);
  // Like a null clock, but `wall` stamps the messages that SubscribeAll() shows. It must outlive the bus.
  explicit InProcessBus(const Clock& wall);
  ~InProcessBus() override;

  void SubscribeAll(std::function<void(const RawMessage&)> handler) override;
  void PublishRaw(const std::string& channel, const void* data, int size) override;

  // Handles the messages that wait at the time of the call. What handlers publish meanwhile waits for the
  // next call.
  int HandleUntil(TimePoint deadline) override;

 protected:
  void PublishTyped(const std::string& channel, const MessageType& type, const void* message) override;
  void SubscribeTyped(const std::string& channel, const MessageType& type,
                      std::function<void(const void*)> handler) override;
  std::shared_ptr<Outlet> MakeOutlet(const std::string& channel, const MessageType& type) override;

 private:
  struct Slot;
  struct Handler;
  struct Channel;
  class ChannelOutlet;

  Channel& Find(const std::string& name);
  bool IsHeard(const Channel& channel) const;
  void Enqueue(Channel& channel, const MessageType& type, const void* message);
  [[gnu::cold]] void EnqueueEncoded(Channel& channel, const MessageType& type, const void* message);
  void Append(Slot& slot);
  void Done(Slot& slot);
  void Dispatch(const Slot& slot);
  [[gnu::noinline]] void DispatchRaw(const Slot& slot, const Handler& last);
  [[gnu::noinline]] void ShowTaps(const Slot& slot);

  const Clock* stamps_;
  SimulatedClock* clock_;  // null: wall time
  bool handling_ = false;
  std::unordered_map<std::string, std::unique_ptr<Channel>> channels_;
  std::array<Channel*, 16> recent_{};  // by the address of the caller's name, whose text is then compared
  std::deque<std::function<void(const RawMessage&)>> taps_;
  std::vector<uint8_t> encoded_;  // reused for each message
  Slot* oldest_ = nullptr;        // of the waiting messages
  Slot* newest_ = nullptr;        // while there is an oldest
};

}  // namespace hydro::bus
