// Takes the motor commands of the pressure loop. It decides which command acts at a tick and when none may,
// and notices what is wrong with them (docs/safety.md). In lockstep it also knows which answers to a tick
// have not come yet.
#pragma once

#include <cstdint>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <optional>

#include "base/integers.h"
#include "base/ring_queue.h"
#include "bus/sequence_monitor.h"
#include "plant/output_safety.h"
#include "plant/run_start.h"
#include "process/counted_warning.h"
#include "process/participant.h"
#include "process/timing/round_trip_monitor.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class MotorCommands {
 public:
  // Subscribes; the other objects must outlive this one and the bus. A voltage that is driven at a tick acts
  // `ticks_ahead` ticks later.
  MotorCommands(process::Participant& participant, const settings::StackConfig& config, OutputSafety& safety,
                const RollCall& roll_call, int64_t ticks_ahead);

  // The state of this tick is now the newest, and asks for answers.
  void SetTick(int64_t tick) {
    tick_ = tick;
    asks_pressure_ = pressure_ticks_.Contains(tick);
    asks_position_ = position_ticks_.Contains(tick);
  }
  // Call it just before that state is sent. Returns the time, or `now` where the difference does not matter.
  bus::Clock::TimePoint BeforeSending(bus::Clock::TimePoint now) {
    if (!asks_pressure_ || participant_.simulated()) return now;
    now = participant_.clock().Now();
    round_trips_.OnSent(tick_, now);
    return now;
  }
  // Real time: the ticks for which this process has just slept took `seconds`. After a long sleep, commands
  // that answer states from before it do not count.
  void OnSlept(double seconds);

  // The commands that are due at this tick come into force.
  void TakeEffect();
  // Whether the command in force is that of a pressure loop which has found something wrong.
  bool SafeInForce() const { return command_ && command_->status == motor_command_t::SAFE; }
  // Whether Check() would find nothing.
  bool AllIsWell(bus::Clock::TimePoint now) const;
  [[gnu::cold]] void Check(bus::Clock::TimePoint now);

  // The command whose voltage may act at this tick; null: none. A command given before or while the voltage
  // was held at zero does not come back into force.
  const motor_command_t* Obeyed(bool held);

  // The role whose answer to this tick is still awaited in lockstep; null when both loops have answered.
  const char* Unanswered() const {
    if (asks_position_ && newest_pressure_command_tick_ < tick_) return "position_ctrl";
    return AwaitsMotorCommand() ? "pressure_ctrl" : nullptr;
  }
  bool AwaitsMotorCommand() const { return asks_pressure_ && newest_tick_ < tick_; }

  // Commands that a sender sent before it turned out to run with another configuration do not act either.
  void ForgetAllOf(int64_t session);

  int64_t lost() const { return monitor_.lost(); }

 private:
  struct Senders {
    std::optional<int64_t> followed, other;  // sessions
  };
  struct Sleep {
    int64_t woke;  // tick
    double seconds;
  };

  void OnMotorCommand(const motor_command_t& command);
  void OnPressureCommand(const pressure_command_t& command);
  void RefuseFutureCommand(const motor_command_t& command);
  void CheckVoltage();
  void CheckSenders(bus::Clock::TimePoint now);
  void CheckFresh();
  bus::Clock::Duration AgeOfAnswer() const;

  process::Participant& participant_;
  OutputSafety& safety_;
  const RollCall& roll_call_;
  const bool realtime_;
  const int64_t pressure_interval_;  // ticks
  const int64_t delay_;              // ticks from the state that a command answers to its voltage's drive
  const double ticks_per_s_;         // of wall time
  const double voltage_limit_;       // V, T_pmax/k_1 beyond rounding
  const double stale_input_s_;
  const bus::Clock::Duration stale_time_;  // the same

  int64_t tick_ = 0;
  Multiples pressure_ticks_, position_ticks_;         // ticks at which each loop answers
  bool asks_pressure_ = true, asks_position_ = true;  // at tick_
  bus::SequenceMonitor monitor_;
  process::CountedWarning repeated_{"repeated_motor_command"};
  std::optional<int64_t>
      future_refused_at_;                // tick: the last command for a future tick, until a later good one
  std::optional<Senders> second_heard_;  // since the last check
  std::optional<Sleep> slept_;  // real time: the last long one, until a command answers a later state
  timing::RoundTripMonitor round_trips_;
  RingQueue<motor_command_t> waiting_;      // received but not yet in force, by tick
  std::optional<motor_command_t> command_;  // in force
  int64_t obeyed_from_ = 0;                 // only commands that answer this tick or a later one act
  int64_t newest_tick_ = -1;                // that a motor command has answered
  int64_t newest_pressure_command_tick_ = -1;
};

}  // namespace hydro::plant
