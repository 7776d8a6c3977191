// A recorded run as the inputs of a controller, in the order in which the controller used them.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/active_faults_t.hpp>
#include <hydro/arm_plan_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/integers.h"
#include "bus/bus.h"
#include "bus/channels.h"
#include "runs/recorded/run_log.h"
#include "settings/stack_config.h"

namespace hydro::hydro_log {

// The first message of each tick. A later one of the same tick is a repetition or comes from a watchdog.
template <class Message>
std::map<int64_t, Message> ByTick(const std::vector<Message>& messages) {
  std::map<int64_t, Message> by_tick;
  for (const Message& message : messages) by_tick.emplace(message.tick, message);
  return by_tick;
}

// The answers of the pressure loop, without those from the end of the run. Where a log begins in the middle
// of a run, answers whose pressure command was sent before are left out as well. Throws InputError when there
// are none.
std::map<int64_t, motor_command_t> RecordedMotorCommands(const runs::RunLog& log);

// The messages without their sequence numbers, which depend on where a replay begins.
template <class Message>
std::vector<Message> Unnumbered(const std::map<int64_t, Message>& by_tick) {
  std::vector<Message> messages;
  messages.reserve(by_tick.size());
  for (const auto& [tick, message] : by_tick) {
    messages.push_back(message);
    messages.back().sequence = 0;
  }
  return messages;
}

class RecordedRun {
 public:
  // `role` is the role of the process that is replayed. Throws InputError when the log has no description of
  // its run or no states.
  RecordedRun(const runs::RunLog& log, const std::string& role);

  const settings::StackConfig& config() const { return config_; }  // in real time, so nothing waits
  const run_description_t& description() const { return description_; }
  int64_t first_tick() const { return states_.begin()->first; }
  std::optional<int64_t> FirstGap() const;
  int64_t states() const { return static_cast<int64_t>(states_.size()); }

  // The actions of a feed between its messages.
  struct Steps {
    std::function<void(double elapsed_s)>
        advance;  // plant time since the first state, before anything of the new state is sent
    std::function<void(int64_t tick)> before;          // may send what came before the state of that tick
    std::function<void()> deliver;                     // after each message
    std::function<bool(const state_t& state)> answer;  // after each state; false ends the feed
  };

  // Sends the states one by one, and before each state the other inputs that the process used. `speed` is in
  // recorded seconds per wall second; 0: as fast as possible.
  void Feed(bus::Bus& bus, const bus::Channels& channels, double speed, const Steps& steps);

 private:
  template <class Message>
  void Overtake(bus::Bus& bus, const bus::Channels& channels, int64_t utime, const Steps& steps,
                const std::vector<Message>& messages, size_t* next);
  void ReadPlans(const std::vector<arm_plan_t>& plans);
  void ReadOthers(const runs::RunLog& log, const std::string& role);

  run_description_t description_;
  settings::StackConfig config_;
  std::map<int64_t, state_t> states_;
  std::vector<fault_t> faults_;
  std::vector<active_faults_t> active_faults_;
  std::vector<process_status_t> statuses_;
  size_t next_fault_ = 0, next_active_ = 0, next_status_ = 0;
  std::vector<std::pair<int64_t, arm_plan_t>> plans_;  // with the tick after which each is sent
  std::vector<tuned_settings_t> tunings_;  // acts_at: the tick from which the replayed process used them
};

// The derivative of the first sample needs the sample before it, which is missing in a log that begins in the
// middle of a run. So this removes the answer to the first sample.
template <class Commands>
void CutFirstSample(const RecordedRun& run, Commands& commands) {
  if (run.first_tick() <= 0) return;
  const int64_t interval = run.config().position_interval_ticks;
  const int64_t since_sample = run.first_tick() % interval;
  const int64_t first_sample =
      since_sample == 0 ? run.first_tick() : SaturatingSum(run.first_tick(), interval - since_sample);
  commands.erase(commands.begin(), commands.upper_bound(first_sample));
}

}  // namespace hydro::hydro_log
