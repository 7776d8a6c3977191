// Turns messages into runs, in the same way for a bus and for a log.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "bus/channels.h"
#include "scope/signals/pending_ticks.h"
#include "scope/signals/run.h"

namespace hydro::scope {

class RunBuilder {
 public:
  // `next_run` makes a new run for another plant session after the run before it has ended. It is also called
  // for the first run. The run that it returns must live until the next call.
  RunBuilder(const std::string& suffix, std::function<Run*(int64_t session)> next_run);
  RunBuilder(const RunBuilder&) = delete;
  RunBuilder& operator=(const RunBuilder&) = delete;

  // Takes a message as it was received, and ignores messages that do not belong to a stack with that suffix.
  // `utime` is its arrival in us.
  void Take(std::string_view channel, const uint8_t* data, int size, int64_t utime);

  // The same for the channels of the limb to which this joint's stack belongs: what concerns all joints
  // counts as this joint's too.
  void TakeOfLimb(const bus::Channels& limb, std::string_view channel, const uint8_t* data, int size,
                  int64_t utime);

  // No more messages are coming for now, so rows that wait for answers are complete.
  void Flush() { ticks_.Flush(); }

  int64_t states() const { return states_; }
  int64_t undecodable() const { return undecodable_; }
  int64_t foreign() const { return foreign_; }  // states of a second plant
  // The plant time and tick of the newest state.
  double now() const { return time_; }
  int64_t tick() const { return tick_; }
  // The plant time of a tick.
  double TimeOf(int64_t tick) const;

 private:
  void OnState(const state_t& state, int64_t utime);
  bool Follow(const state_t& state, int64_t utime);
  void OnReference(const arm_reference_t& reference);
  void FollowSampling(int64_t ticks);

  // run_builder_events.cc
  bool TakeRare(std::string_view channel, const uint8_t* data, int size, int64_t utime);
  void OnDescription(const run_description_t& description);
  void OnFault(const fault_t& fault);
  void OnActiveFaults(const active_faults_t& active);
  void OnStop(const stop_t& stop, int64_t utime);
  void OnSettings(const tuned_settings_t& settings);
  void OnTuningAnswer(const tuning_answer_t& answer);
  void OnRearm(const rearm_t& rearm, int64_t utime);
  void OnStatus(const process_status_t& status);
  void OnStatistics(const loop_statistics_t& statistics);
  ProcessReport& Report(const std::string& role, const std::string& host);
  void AddEvent(double t, std::string kind, const std::string& source, const std::string& code,
                const std::string& text);

  const bus::Channels channels_;
  std::function<Run*(int64_t)> next_run_;
  Run* run_ = nullptr;
  PendingTicks ticks_;
  state_t state_;  // decoded into, reused
  motor_command_t command_;
  int64_t states_ = 0;
  int64_t undecodable_ = 0;
  int64_t foreign_ = 0;

  // Session of the plant that is followed.
  std::optional<int64_t> session_;
  bool left_ = false;  // the plant has ended
  int64_t heard_utime_ = 0;
  int64_t sequence_ = -1;
  int64_t tick_ = -1;
  double time_ = 0;
  int64_t sample_ticks_ = 1;  // interval before the newest state

  std::optional<run_description_t> early_description_;

  // The reference, and the time since which it rests.
  std::optional<double> reference_;
  double rests_since_ = 0;

  std::map<int64_t, int64_t> fault_sequence_;            // the newest number of each sender
  std::map<std::string, std::set<std::string>> active_;  // faults by role
  std::map<std::string, std::set<std::string>>
      doubted_;                            // active here, but missing from the role's last list
  std::optional<tuned_settings_t> tuned_;  // the newest that was decided; empty: none has been heard
  int64_t tuning_request_ = -1;            // the last one that was refused
  ProcessReport flood_;                    // takes the reports of processes beyond those that are kept
  std::string last_stop_;
  std::string last_rearm_;
  int64_t last_stop_utime_ = 0;
  int64_t last_rearm_utime_ = 0;
};

}  // namespace hydro::scope
