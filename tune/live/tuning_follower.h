// A controller's side of a change of values while the stack runs. It receives the plant's tuned_settings_t,
// reports whether it can act by them, and hands them over at the tick from which they hold.
//
// The plant proposes a version. Every controller prepares it and reports this. The plant then decides at
// which tick the version takes effect, and all controllers act by it from that tick on. A controller that
// missed the decision (because of a restart or lost messages) takes the version from the plant's next report,
// at its own next tick.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/tuned_settings_t.hpp>
#include <hydro/tuning_status_t.hpp>
#include <optional>
#include <string>

#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::tuning {

// In samples of the position loop: a first state after more than this belongs to a run in progress.
inline constexpr int64_t kJoiningSamples = 10;

class TuningFollower {
 public:
  // Returns one line that says why this process cannot act by the settings; empty: it can. It is called
  // before they are decided.
  using Prepare = std::function<std::string(const tuned_settings_t&)>;

  // Subscribes. `participant` must outlive this object and the bus.
  TuningFollower(process::Participant& participant, const settings::StackConfig& config, Prepare prepare);

  // The settings that take effect at this tick; null: those in force stay. Call it once for each tick on
  // which the loop acts.
  const tuned_settings_t* TakeDueAt(int64_t tick) { return waiting_ ? TakeWaitingAt(tick) : nullptr; }

  // Whether the loop joins a run in progress and has not yet heard which values are in force. Until then it
  // must not act, not even by the values of its configuration. Call it with each state. It is always false in
  // lockstep and on simulated time (a record replayed from its middle is not a run in progress), and false
  // after a second and a half, because a user's own plant may report nothing.
  bool Awaits(int64_t tick) {
    const bool settled = participant_.tick() >= 0 && (!joined_ || heard_);
    return !settled && AwaitsUnsettled(tick);
  }

  // Reports this process's status when it is due. Cheap.
  void Poll(bus::Clock::TimePoint now) {
    if (now >= next_status_ && participant_.state() == process_status_t::RUNNING) Say();
  }

  int64_t in_force() const { return in_force_; }

 private:
  const tuned_settings_t* TakeWaitingAt(int64_t tick);
  bool AwaitsUnsettled(int64_t tick);
  void OnSettings(const tuned_settings_t& settings);
  void Keep(const tuned_settings_t& settings);
  void Date(const tuned_settings_t& settings);
  void Say();

  process::Participant& participant_;
  const int64_t joining_;  // tick: a first state after it belongs to a run in progress
  Prepare prepare_;
  std::optional<tuned_settings_t> waiting_;  // prepared; acts_at is -1 until it is decided
  tuned_settings_t taken_;                   // what was last handed over
  tuning_status_t status_;
  int64_t in_force_ = 0;
  int64_t plant_ = 0;  // session
  bool heard_ = false;
  std::optional<bus::Clock::TimePoint> joined_;
  bus::Clock::TimePoint next_status_;
};

}  // namespace hydro::tuning
