// PlantApp's handling of motor commands: which one acts, and when none may.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "plant/plant_app.h"

namespace hydro::plant {
namespace {

constexpr auto kHeartbeatCheck = std::chrono::milliseconds(10);

}  // namespace

void PlantApp::OnMotorCommand(const motor_command_t& command) {
  if (participant_.Refuses(command.session)) return;
  // Before the run there is no state that a command could answer.
  if (participant_.state() != process_status_t::RUNNING) return;
  const auto now = participant_.clock().Now();
  // This command answers no state; but if another sender than the one that is followed sends it, there is a
  // second sender.
  if (command.tick < 0 && !command_monitor_.FollowsAnother(command.session, now)) return;
  // A command for a future tick never counts as the newest: it would make every later good command look old.
  if (command.tick > tick_ && !command_monitor_.FollowsAnother(command.session, now)) {
    RefuseFutureCommand(command);
    return;
  }
  const auto verdict = command_monitor_.Observe(command.session, command.sequence, command.tick, now);
  // A duplicate is neither obeyed nor a sign of life.
  if (verdict == bus::SequenceMonitor::Verdict::kDuplicate) return;
  if (verdict == bus::SequenceMonitor::Verdict::kSecondSender) return;  // CheckCommand() raises the fault
  if (verdict == bus::SequenceMonitor::Verdict::kRestarted) {
    // No command of the previous sender acts any more, neither one that waits nor the one in force: the
    // voltage is zero until the new sender's own commands act.
    waiting_commands_.clear();
    command_.reset();
  }
  // While a second sender is heard too, neither sender's commands act, even if one of them has long been
  // silent when the tick comes (lockstep waits).
  if (command_monitor_.SecondSenderAlive(now)) obeyed_from_ = std::max(obeyed_from_, command.tick + 1);
  future_command_ = false;
  if (const auto taken = round_trips_.OnAnswer(command.tick, now)) {
    participant_.statistics().RecordRoundTrip(*taken);
  }
  waiting_commands_.push_back(command);
  // The answer to a repeated state may come after the answer to a newer state. A successor has answered
  // nothing yet.
  const bool successor = verdict == bus::SequenceMonitor::Verdict::kRestarted;
  newest_command_tick_ = successor ? command.tick : std::max(newest_command_tick_, command.tick);
}

// The plant obeys the pressure loop alone; in lockstep it also waits for the answer of the position loop of
// this run, and of no other.
void PlantApp::OnPressureCommand(const pressure_command_t& command) {
  if (command.tick > tick_ || participant_.Refuses(command.session)) return;
  if (!roll_call_.Has("position_ctrl", command.session)) return;
  newest_pressure_command_tick_ = std::max(newest_pressure_command_tick_, command.tick);
}

// Commands that a sender sent before it turned out to run with another configuration do not act either.
void PlantApp::ForgetCommandsOf(int64_t session) {
  waiting_commands_.erase_if([&](const motor_command_t& command) { return command.session == session; });
  if (command_ && command_->session == session) command_.reset();
  // Lockstep then waits for another sender's command.
  if (command_monitor_.session() == session) newest_command_tick_ = -1;
}

void PlantApp::RefuseFutureCommand(const motor_command_t& command) {
  future_command_ = true;
  safety_.Set(VoltageGuard::Cause::kFutureCommand, true, [&] {
    return OutputSafety::Finding{
        fmt::format("a motor command for tick {} at tick {}; is another run's log being played?",
                    command.tick, tick_),
        static_cast<double>(command.tick), static_cast<double>(tick_)};
  });
}

// How long the newest state that asks for a command has gone unanswered: the age, in ticks, of the state that
// the newest command answers, less the interval. A loop that works through a backlog, or repeats itself, is
// not in control, however often it sends. Time for which this process itself was stopped also makes the
// command in force older.
bus::Clock::Duration PlantApp::AgeOfAnswer() const {
  const int64_t interval = config_.pressure_interval_ticks;
  const int64_t answered = !waiting_commands_.empty() ? waiting_commands_.back().tick
                           : command_                 ? command_->tick
                                                      : -interval;
  const auto ticks = static_cast<double>(tick_ - answered - interval);
  return bus::FromSeconds(std::clamp(ticks / (config_.plant.rate_hz * config_.time.speed), 0.0, 1e8));
}

void PlantApp::Check(bus::Clock::TimePoint now) {
  const int64_t newest_allowed = tick_ + ticks_ahead_ - config_.plant.command_delay_ticks;
  while (!waiting_commands_.empty() && waiting_commands_.front().tick <= newest_allowed) {
    command_ = waiting_commands_.front();
    waiting_commands_.pop_front();
  }
  const bool safe_command = command_ && command_->status == motor_command_t::SAFE;
  if (!safety_.AllIsWell(state_, safe_command, rig_.faults()) || !CommandIsWell(now)) CheckAll(now);
  if (realtime_) CheckSupervisor(now);
  safety_.CheckSuspended(now);
  if (!siblings_.follows()) return;
  HoldForSilence(siblings_.Silence(now));
  HoldForOthers(siblings_.Fault(now));
  if (const auto& stop = siblings_.stop()) participant_.RequestStop(stop->reason, stop->exit_code);
}

// Chooses the voltage of the command in force, or zero while any check fails. Drive() puts it out first and
// publishes the faults second.
void PlantApp::ChooseVoltage() {
  // A command given before or while the voltage was held at zero does not come back into force.
  const bool held = safety_.holds() || !rig_.faults().empty();
  if (held) obeyed_from_ = tick_;
  // The run may have ended since this tick began.
  const bool obeys = !held && command_ && command_->tick >= obeyed_from_ && !participant_.stop();
  voltage_ = safety_.Voltage(obeys ? command_->voltage : 0);
  command_tick_ = obeys ? command_->tick : -1;
  rig_.Obey(command_tick_);
}

// The pressure loop reports its faults in its commands.
bool PlantApp::HasOwnFault() const {
  return safety_.holds_by_itself() || !rig_.faults().empty() ||
         (command_ && command_->status == motor_command_t::SAFE);
}

std::string PlantApp::OwnFault() const {
  if (!rig_.faults().empty()) return rig_.faults().front().code;
  const std::string cause = safety_.OwnCause();
  return cause.empty() ? "the pressure loop commands a safe output" : cause;
}

void PlantApp::HoldForOthers(const std::string& text) { HoldWhile(VoltageGuard::Cause::kOtherJoint, text); }

void PlantApp::HoldForSilence(const std::string& text) { HoldWhile(VoltageGuard::Cause::kJointGone, text); }

void PlantApp::HoldWhile(VoltageGuard::Cause cause, const std::string& text) {
  safety_.Set(cause, !text.empty(), [&] {
    return OutputSafety::Finding{fmt::format("tick {}: {}", tick_, text), NAN, NAN};
  });
}

// Whether CheckCommand() and CheckCommandIsFresh() would find nothing.
inline bool PlantApp::CommandIsWell(bus::Clock::TimePoint now) const {
  const double voltage = command_ ? command_->voltage : 0;
  if (!(std::fabs(voltage) <= voltage_limit_) || future_command_) return false;
  if (command_monitor_.SecondSenderAlive(now)) return false;
  return !realtime_ || (AgeOfAnswer() <= stale_time_ && !awake_again_ &&
                        repeated_commands_.IsQuiet(command_monitor_.duplicates()));
}

void PlantApp::CheckAll(bus::Clock::TimePoint now) {
  CheckCommand(now);
  if (realtime_) CheckCommandIsFresh();
  safety_.CheckMeasured(state_);
  safety_.CheckRig(rig_.faults());
  safety_.CheckOtherStack(now);
}

void PlantApp::CheckCommand(bus::Clock::TimePoint now) {
  using Cause = VoltageGuard::Cause;
  using Finding = OutputSafety::Finding;
  const double voltage = command_ ? command_->voltage : 0;
  safety_.Set(Cause::kNonfiniteCommand, !std::isfinite(voltage), [&] {
    return Finding{fmt::format("tick {}: the motor command is {} V, must be finite", tick_, voltage), voltage,
                   NAN};
  });
  safety_.Set(Cause::kExcessiveCommand, std::isfinite(voltage) && std::fabs(voltage) > voltage_limit_, [&] {
    return Finding{
        fmt::format("tick {}: the motor command is {:.6g} V, allowed are +/- {:.6g} V (T_pmax/k_1)", tick_,
                    voltage, voltage_limit_),
        voltage, voltage_limit_};
  });
  // The sender contradicts itself, so the command before this one is no more trustworthy.
  safety_.Set(Cause::kFutureCommand, future_command_, [] { return Finding{}; });
  safety_.Set(Cause::kSecondCommandSender, command_monitor_.SecondSenderAlive(now), [&] {
    return Finding{fmt::format("two processes send motor commands: {} and {}; allowed is one",
                               participant_.NameOf(command_monitor_.session()),
                               participant_.NameOf(command_monitor_.second_session())),
                   2, 1};
  });
  safety_.CheckController(command_ && command_->status == motor_command_t::SAFE, now);
  // In lockstep the plant itself asks for repeats; in real time no process does.
  if (realtime_) {
    repeated_commands_.Update(
        command_monitor_.duplicates(), now,
        [&](int64_t count) {
          return fmt::format(
              "tick {}: {} motor commands in all came twice or behind newer ones; they are "
              "not obeyed",
              tick_, count);
        },
        participant_);
  }
}

// A person at the terminal believes that the launcher is in charge; while the launcher is stopped, it is not.
void PlantApp::CheckSupervisor(bus::Clock::TimePoint now) {
  if (!heartbeat_ || now < next_heartbeat_check_) return;
  next_heartbeat_check_ = now + kHeartbeatCheck;
  if (heartbeat_()) newest_heartbeat_ = now;
  const double silence = newest_heartbeat_ ? bus::ToSeconds(now - *newest_heartbeat_) : 0;
  const double allowed = config_.limits.stale_supervisor_s;
  safety_.Set(VoltageGuard::Cause::kSupervisorGone, silence > allowed, [&] {
    return OutputSafety::Finding{fmt::format("tick {}: hydro-launch, which started this process, has not "
                                             "been heard for {:.2f} s, allowed are {} s "
                                             "(limits.stale_supervisor_s); is it stopped (Ctrl-Z)?",
                                             tick_, silence, allowed),
                                 silence, allowed};
  });
}

void PlantApp::CheckCommandIsFresh() {
  using Cause = VoltageGuard::Cause;
  using Finding = OutputSafety::Finding;
  const auto age = AgeOfAnswer();
  safety_.Set(Cause::kStaleCommand, age > stale_time_, [&] {
    return Finding{
        fmt::format("tick {}: no motor command for {:.0f} ms, allowed are {:.0f} ms (limits.stale_input_s)",
                    tick_, 1e3 * bus::ToSeconds(age), 1e3 * bus::ToSeconds(stale_time_)),
        bus::ToSeconds(age), config_.limits.stale_input_s};
  });
  // After this process itself was stopped, commands that answer states from before the stop do not count.
  if (awake_again_ && command_ && command_->tick >= *awake_again_) awake_again_.reset();
  safety_.Set(Cause::kLatePlant, awake_again_.has_value(), [&] {
    const double slept =
        static_cast<double>(state_.skipped_ticks) / (config_.plant.rate_hz * config_.time.speed);
    return Finding{fmt::format("tick {}: the loop was stopped for {:.0f} ms, allowed are {:.0f} ms "
                               "(limits.stale_input_s)",
                               tick_, 1e3 * slept, 1e3 * bus::ToSeconds(stale_time_)),
                   slept, config_.limits.stale_input_s};
  });
}

}  // namespace hydro::plant
