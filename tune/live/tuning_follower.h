// A controller's side of a change of values while the stack runs: it hears the plant's tuned_settings_t, says whether it can act by them, and
// hands them over at the tick from which they hold.
//
// The plant proposes a version, every controller prepares it and says so, the plant decides at which tick it takes effect, and all
// act by it from that tick on. Who was not there when it was decided (a restart, messages lost) takes it with the plant's next
// report, at its own next tick.
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

// Of the position loop: a first state after so many is one of a run that goes on.
inline constexpr int64_t kJoiningSamples = 10;

class TuningFollower {
 public:
  // Why this process cannot act by the settings, as one line; empty: it can. Called before they are decided.
  using Prepare = std::function<std::string(const tuned_settings_t&)>;

  // Subscribes; `participant` must outlive it and the bus.
  TuningFollower(process::Participant& participant, const settings::StackConfig& config, Prepare prepare);

  // The settings that take effect at this tick; null: those in force stay. Asked once for each tick on which the loop acts.
  const tuned_settings_t* TakeDueAt(int64_t tick) { return waiting_ ? TakeWaitingAt(tick) : nullptr; }

  // Whether the loop joins a run and has yet to hear which values are in force there: until then it acts by none, not by those of
  // its configuration. Asked with each state. Never in lockstep or on simulated time (a record that is replayed from its middle is no such run), and
  // false after a second and a half, because a plant of the user's own may say nothing.
  bool Awaits(int64_t tick) {
    const bool settled = participant_.tick() >= 0 && (!joined_ || heard_);
    return !settled && AwaitsUnsettled(tick);
  }

  // Says where this process is, when due. Cheap.
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
  const int64_t joining_;  // tick: a first state behind it is one of a run that goes on
  Prepare prepare_;
  std::optional<tuned_settings_t> waiting_;  // prepared; acts_at is -1 until it is decided
  tuned_settings_t taken_;                   // what was handed over last
  tuning_status_t status_;
  int64_t in_force_ = 0;
  int64_t plant_ = 0;  // session
  bool heard_ = false;
  std::optional<bus::Clock::TimePoint> joined_;
  bus::Clock::TimePoint next_status_;
};

}  // namespace hydro::tuning
