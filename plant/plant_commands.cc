// PlantApp's handling of motor commands: which one acts, and when none may.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "plant/plant_app.h"

namespace hydro {
void PlantApp::OnMotorCommand(const motor_command_t& command) {
  const auto now = participant_.clock().Now();
  const auto verdict = command_monitor_.Observe(command.session, command.sequence, now);
  if (verdict == SequenceMonitor::Verdict::kDuplicate) return;
  if (verdict == SequenceMonitor::Verdict::kSecondSender) return;  // ChooseVoltage() sees to it
  if (verdict == SequenceMonitor::Verdict::kRestarted) waiting_commands_.clear();
  if (command.tick > tick_) {
    participant_.Raise(
        "future_motor_command",
        fmt::format("a motor command for tick {} at tick {}; is another run's log being played?",
                    command.tick, tick_),
        static_cast<double>(command.tick), static_cast<double>(tick_), false);
    return;
  }
  if (participant_.any_fault()) participant_.Clear("future_motor_command");
  waiting_commands_.push_back(command);
  newest_command_tick_ = command.tick;
  unanswered_since_.reset();
  const int64_t newest_due = tick_ / config_.pressure_interval_ticks * config_.pressure_interval_ticks;
  if (command.tick < newest_due) unanswered_since_ = now - TimeSinceDue(command.tick);
}

// How long ago the state after that of `tick` asked for an answer: a loop that works off what has piled up,
// or repeats itself, is not in control however often it sends.
Clock::Duration PlantApp::TimeSinceDue(int64_t tick) const {
  const double ticks = static_cast<double>(tick_) - static_cast<double>(tick) -
                       static_cast<double>(config_.pressure_interval_ticks);
  return FromSeconds(std::clamp(ticks / (config_.plant.rate_hz * config_.time.speed), 0.0, 1e8));
}

void PlantApp::ChooseVoltage() {
  const int64_t newest_allowed = tick_ - config_.plant.command_delay_ticks;
  while (!waiting_commands_.empty() && waiting_commands_.front().tick <= newest_allowed) {
    command_ = waiting_commands_.front();
    waiting_commands_.pop_front();
  }
  voltage_ = command_ ? command_->voltage : 0;
  command_tick_ = command_ ? command_->tick : -1;
  const auto zero = [&] {
    voltage_ = 0;
    command_tick_ = -1;
  };
  if (!std::isfinite(voltage_)) {
    const double found = voltage_;
    zero();
    participant_.Raise("nonfinite_motor_command",
                       fmt::format("tick {}: the motor command is {} V, must be finite", tick_, found), found,
                       NAN, false);
  } else if (participant_.any_fault()) {
    participant_.Clear("nonfinite_motor_command");
  }
  if (participant_.active("future_motor_command")) zero();  // contradictory: what came before it is no better
  if (command_monitor_.SecondSenderAlive(participant_.clock().Now())) {
    zero();
    participant_.Raise("second_motor_command_sender",
                       "two processes send motor commands on this network; allowed is one", 2, 1, false);
  } else if (participant_.any_fault()) {
    participant_.Clear("second_motor_command_sender");
  }
}

void PlantApp::CheckCommandIsFresh() {
  const auto now = participant_.clock().Now();
  const auto age = now - unanswered_since_.value_or(now);
  if (age <= stale_time_) {
    if (participant_.any_fault()) participant_.Clear("stale_motor_command");
    return;
  }
  voltage_ = 0;  // zero volts first, explanation second
  command_tick_ = -1;
  participant_.Raise(
      "stale_motor_command",
      fmt::format("tick {}: no motor command for {:.0f} ms, allowed are {:.0f} ms (limits.stale_input_s)",
                  tick_, 1e3 * ToSeconds(age), 1e3 * ToSeconds(stale_time_)),
      ToSeconds(age), config_.limits.stale_input_s, false);
}

}  // namespace hydro
