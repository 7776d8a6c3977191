#include "plant/motor_commands.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace hydro::plant {
namespace {

// Whether a command of that status may move the motor. A loop that says that it is at a safe output, or what
// nobody knows, moves nothing, whatever its voltage.
bool Drives(int8_t status) { return status == motor_command_t::LAW || status == motor_command_t::OPEN_LOOP; }

}  // namespace

MotorCommands::MotorCommands(process::Participant& participant, const settings::StackConfig& config,
                             OutputSafety& safety, const RollCall& roll_call, int64_t ticks_ahead)
    : participant_(participant),
      safety_(safety),
      roll_call_(roll_call),
      realtime_(config.time.mode == settings::TimeMode::kRealtime),
      pressure_interval_(config.pressure_interval_ticks),
      delay_(config.plant.command_delay_ticks - ticks_ahead),
      ticks_per_s_(config.plant.rate_hz * config.time.speed),
      voltage_limit_((1 + 1e-9) * config.model.description.parameters.T_pmax /
                     config.model.description.parameters.k_1),
      stale_input_s_(config.limits.stale_input_s),
      stale_time_(bus::FromSeconds(stale_input_s_)),
      pressure_ticks_(config.pressure_interval_ticks),
      position_ticks_(config.position_interval_ticks),
      monitor_(stale_time_) {
  bus::Bus& bus = participant_.bus();
  const bus::Channels& channels = participant_.channels();
  bus.Subscribe<motor_command_t>(channels.Of<motor_command_t>(),
                                 [this](const motor_command_t& command) { OnMotorCommand(command); });
  bus.Subscribe<pressure_command_t>(
      channels.Of<pressure_command_t>(),
      [this](const pressure_command_t& command) { OnPressureCommand(command); });
}

void MotorCommands::OnMotorCommand(const motor_command_t& command) {
  if (participant_.Refuses(command.session)) return;
  // Before the run there is no state that a command could answer.
  if (participant_.state() != process_status_t::RUNNING) return;
  const auto now = participant_.clock().Now();
  // This command answers no state; but if another sender than the one that is followed sends it, there is a
  // second sender.
  if (command.tick < 0 && !monitor_.FollowsAnother(command.session, now)) return;
  // A command for a future tick never counts as the newest: it would make every later good command look old.
  if (command.tick > tick_ && !monitor_.FollowsAnother(command.session, now)) {
    RefuseFutureCommand(command);
    return;
  }
  const auto verdict = monitor_.Observe(command.session, command.sequence, command.tick, now);
  // A duplicate is neither obeyed nor a sign of life.
  if (verdict == bus::SequenceMonitor::Verdict::kDuplicate) return;
  if (verdict == bus::SequenceMonitor::Verdict::kSecondSender) {  // CheckSenders() raises the fault
    second_heard_ = Senders{monitor_.session(), command.session};
    return;
  }
  if (verdict == bus::SequenceMonitor::Verdict::kRestarted) {
    // No command of the previous sender acts any more, neither one that waits nor the one in force: the
    // voltage is zero until the new sender's own commands act.
    waiting_.clear();
    command_.reset();
  }
  // While a second sender is heard too, neither sender's commands act, even if one of them has long been
  // silent when the tick comes (lockstep waits).
  if (monitor_.SecondSenderAlive(now)) obeyed_from_ = std::max(obeyed_from_, command.tick + 1);
  // The fault outlives the tick of its detection, so that it is told even where the good command came with
  // it.
  if (future_refused_at_ && *future_refused_at_ < tick_) future_refused_at_.reset();
  if (const auto taken = round_trips_.OnAnswer(command.tick, now)) {
    participant_.statistics().RecordRoundTrip(*taken);
  }
  waiting_.push_back(command);
  // The answer to a repeated state may come after the answer to a newer state. A successor has answered
  // nothing yet.
  const bool successor = verdict == bus::SequenceMonitor::Verdict::kRestarted;
  newest_tick_ = successor ? command.tick : std::max(newest_tick_, command.tick);
}

// The plant obeys the pressure loop alone; in lockstep it also waits for the answer of the position loop of
// this run, and of no other.
void MotorCommands::OnPressureCommand(const pressure_command_t& command) {
  if (command.tick > tick_ || participant_.Refuses(command.session)) return;
  if (!roll_call_.Has("position_ctrl", command.session)) return;
  newest_pressure_command_tick_ = std::max(newest_pressure_command_tick_, command.tick);
}

void MotorCommands::ForgetAllOf(int64_t session) {
  waiting_.erase_if([&](const motor_command_t& command) { return command.session == session; });
  if (command_ && command_->session == session) command_.reset();
  // Lockstep then waits for another sender's command.
  if (monitor_.session() == session) newest_tick_ = -1;
}

void MotorCommands::RefuseFutureCommand(const motor_command_t& command) {
  future_refused_at_ = tick_;
  safety_.Set(VoltageGuard::Cause::kFutureCommand, true, [&] {
    return OutputSafety::Finding{
        fmt::format("a motor command for tick {} at tick {}; is another run's log being played?",
                    command.tick, tick_),
        static_cast<double>(command.tick), static_cast<double>(tick_)};
  });
}

void MotorCommands::OnSlept(double seconds) {
  if (bus::FromSeconds(seconds) > stale_time_) slept_ = {tick_, seconds};
}

// How long the newest state that asks for a command has gone unanswered: the age, in ticks, of the state that
// the newest command answers, less the interval. A loop that works through a backlog, or repeats itself, is
// not in control, however often it sends. Time for which this process itself was stopped also makes the
// command in force older.
bus::Clock::Duration MotorCommands::AgeOfAnswer() const {
  const int64_t answered = !waiting_.empty() ? waiting_.back().tick
                           : command_        ? command_->tick
                                             : -pressure_interval_;
  const auto ticks = static_cast<double>(tick_ - answered - pressure_interval_);
  return bus::FromSeconds(std::clamp(ticks / ticks_per_s_, 0.0, 1e8));
}

void MotorCommands::TakeEffect() {
  const int64_t newest_allowed = tick_ - delay_;
  while (!waiting_.empty() && waiting_.front().tick <= newest_allowed) {
    command_ = waiting_.front();
    if (!Drives(command_->status)) command_->voltage = 0;
    waiting_.pop_front();
  }
}

const motor_command_t* MotorCommands::Obeyed(bool held) {
  if (held) obeyed_from_ = std::max(obeyed_from_, tick_);
  // The run may have ended since this tick began.
  const bool obeys = !held && command_ && command_->tick >= obeyed_from_ && !participant_.stop();
  return obeys ? &*command_ : nullptr;
}

bool MotorCommands::AllIsWell(bus::Clock::TimePoint now) const {
  const double voltage = command_ ? command_->voltage : 0;
  if (!(std::fabs(voltage) <= voltage_limit_) || future_refused_at_) return false;
  if (monitor_.SecondSenderAlive(now) || second_heard_) return false;
  return !realtime_ || (AgeOfAnswer() <= stale_time_ && !slept_ && repeated_.IsQuiet(monitor_.duplicates()));
}

void MotorCommands::Check(bus::Clock::TimePoint now) {
  CheckVoltage();
  CheckSenders(now);
  safety_.CheckController(SafeInForce(), now);
  // In lockstep the plant itself asks for repeats; in real time no process does.
  if (!realtime_) return;
  repeated_.Update(
      monitor_.duplicates(), now,
      [&](int64_t count) {
        return fmt::format(
            "tick {}: {} motor commands in all came twice or behind newer ones; they are not obeyed", tick_,
            count);
      },
      participant_);
  CheckFresh();
}

void MotorCommands::CheckVoltage() {
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
}

void MotorCommands::CheckSenders(bus::Clock::TimePoint now) {
  using Cause = VoltageGuard::Cause;
  using Finding = OutputSafety::Finding;
  // The sender contradicts itself, so the command before this one is no more trustworthy.
  safety_.Set(Cause::kFutureCommand, future_refused_at_.has_value(), [] { return Finding{}; });
  // In lockstep a tick may wait for longer than a sender counts as alive.
  safety_.Set(Cause::kSecondCommandSender, monitor_.SecondSenderAlive(now) || second_heard_, [&] {
    const auto [one, other] = second_heard_.value_or(Senders{monitor_.session(), monitor_.second_session()});
    return Finding{fmt::format("two processes send motor commands: {} and {}; allowed is one",
                               participant_.NameOf(one), participant_.NameOf(other)),
                   2, 1};
  });
  second_heard_.reset();
}

void MotorCommands::CheckFresh() {
  using Cause = VoltageGuard::Cause;
  using Finding = OutputSafety::Finding;
  const auto age = AgeOfAnswer();
  safety_.Set(Cause::kStaleCommand, age > stale_time_, [&] {
    return Finding{
        fmt::format("tick {}: no motor command for {:.0f} ms, allowed are {:.0f} ms (limits.stale_input_s)",
                    tick_, 1e3 * bus::ToSeconds(age), 1e3 * bus::ToSeconds(stale_time_)),
        bus::ToSeconds(age), stale_input_s_};
  });
  if (slept_ && command_ && command_->tick >= slept_->woke) slept_.reset();
  safety_.Set(Cause::kLatePlant, slept_.has_value(), [&] {
    return Finding{fmt::format("tick {}: the loop was stopped for {:.0f} ms, allowed are {:.0f} ms "
                               "(limits.stale_input_s)",
                               tick_, 1e3 * slept_->seconds, 1e3 * bus::ToSeconds(stale_time_)),
                   slept_->seconds, stale_input_s_};
  });
}

}  // namespace hydro::plant
