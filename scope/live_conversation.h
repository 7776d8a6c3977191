// The conversation with a page: hydro.scope.v1 (docs/developers/scope_protocol.md).
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scope/live_request.h"
#include "scope/operator_actions.h"
#include "scope/run_table.h"
#include "scope/signals/trigger.h"
#include "scope/signals/view.h"
#include "scope/wire/site.h"

namespace hydro::scope {

// The ghost beside a run.
class GhostSwitch {
 public:
  virtual ~GhostSwitch() = default;
  // What became of the request, for the page.
  virtual Outcome Switch(uint32_t run, bool on, double resync_s) = 0;
  virtual Outcome Sync(uint32_t run) = 0;
};

// What conversations share. Everything in it outlives them.
struct LiveContext {
  RunTable& runs;
  OperatorActions& actions;
  GhostSwitch& ghost;
  // Wall time since the last state of a live run, s; negative: none has come.
  std::function<double(uint32_t run)> silent_s;
  std::function<std::chrono::steady_clock::time_point()> now;
  int64_t* frames = nullptr;   // binary messages sent, of all clients
  int64_t* dropped = nullptr;  // frames not made because a client was too slow
};

// The memory is bounded: only requests wait, never frames. When kMostWaiting requests wait, nothing more is
// read.
class LiveConversation : public Conversation {
 public:
  explicit LiveConversation(const LiveContext& context);

  void Hear(std::string_view message, bool binary) override;
  bool Next(Message* message) override;
  bool listens() const override { return waiting_.size() + replies_->size() < kMostWaiting; }
  bool over() const override { return over_; }

 private:
  using TimePoint = std::chrono::steady_clock::time_point;
  static constexpr size_t kMostWaiting = 64;
  static constexpr size_t kMostViews = 16;
  static constexpr size_t kMostTriggers = 8;

  // Work that is due now and then.
  struct Due {
    std::chrono::milliseconds every;
    TimePoint next{};
    bool Now(TimePoint now);
  };

  void Take(const LiveRequest& request);
  void TakeView(const LiveRequest& request);
  void EndView(uint32_t id);
  void TakeTrigger(const LiveRequest& request);
  void Arm(uint32_t id);
  void Mark(const LiveRequest& request);
  Run& RunOf(const LiveRequest& request) const;
  Done ReplyTo(uint32_t id);
  void Reply(uint32_t id, bool ok, const std::string& text, const std::string& data = {});

  bool NextReply(Message* message);
  bool NextEvent(Message* message);
  bool NextCapture(Message* message);
  bool NextStatus(Message* message);
  bool NextFrame(Message* message);
  bool Binary(std::string bytes, Message* message);
  static bool Text(std::string text, Message* message);
  std::string Bins(const LiveRequest& request);
  std::string Values(const LiveRequest& request);
  std::string Dropped();

  LiveContext context_;
  bool greeted_ = false;
  bool over_ = false;
  int wrong_ = 0;  // messages in a row that were not requests
  uint64_t revision_ = 0;
  std::shared_ptr<std::deque<std::string>> replies_;  // shared with answers that arrive later
  std::deque<LiveRequest> waiting_;                   // requests of the kinds get and values
  // How far a run's events have been sent.
  struct Heard {
    const Run* run = nullptr;
    int64_t session = 0;
    uint64_t n = 0;
  };
  std::map<uint32_t, Heard> heard_;
  std::map<uint32_t, View> views_;
  std::map<uint32_t, Trigger> triggers_;
  std::string capture_;     // sent after its state
  uint32_t last_view_ = 0;  // the views take turns
  Due clock_{std::chrono::milliseconds(100)};
  Due processes_{std::chrono::milliseconds(1000)};
  Due runs_{std::chrono::milliseconds(200)};
  Due dropped_{std::chrono::milliseconds(1000)};
  std::map<uint32_t, std::string> tunings_;  // by run, the message that was sent last
  std::deque<std::string> said_;             // by the live runs, and still to be sent
  uint64_t told_bins_ = 0;
  uint64_t told_frames_ = 0;
  uint64_t past_bins_ = 0;  // of views that have ended
  uint64_t past_frames_ = 0;
};

}  // namespace hydro::scope
