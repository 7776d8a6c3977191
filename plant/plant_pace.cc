// PlantApp's two ways to pace a run: lockstep, which waits for every answer, and real time, which waits for
// none.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "base/copy_words.h"
#include "plant/plant_app.h"
#include "process/timing/fixed_rate_loop.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr auto kStateRepeatPeriod = 100ms;  // lockstep: how often an unanswered state is sent again
// Lockstep: how far the plant may run ahead of a logger; about half of what Linux's default receive buffer
// (208 KiB) holds.
constexpr int64_t kLoggerWindowTicks = 64;

}  // namespace

inline void PlantApp::SetTick(int64_t tick) {
  tick_ = tick;
  asks_pressure_ = pressure_ticks_.Contains(tick);
  asks_position_ = position_ticks_.Contains(tick);
  participant_.set_tick(tick);
}

inline void PlantApp::Measure(int64_t tick) {
  model::Measurement measured;
  CopyFresh(&measured, rig_.Read(tick));
  state_.motor_angle = measured.motor_angle;
  state_.motor_speed = measured.motor_speed;
  state_.arm_angle = measured.arm_angle;
  state_.arm_speed = measured.arm_speed;
  state_.p1 = measured.p1;
  state_.p2 = measured.p2;
}

inline void PlantApp::Advance(int64_t to_tick) {
  state_.voltage = voltage_;
  state_.command_tick = command_tick_;
  tuning_.OnTick(to_tick);
  Measure(to_tick);
  SetTick(to_tick);
}

// Returns when the state was sent, or `now` where the difference does not matter.
inline bus::Clock::TimePoint PlantApp::Publish(int64_t skipped_ticks, bus::Clock::TimePoint now) {
  if (tick_ == 0) {
    state_.voltage = 0;
    state_.command_tick = -1;
    state_.sequence = 0;
    SetTick(0);
  } else {
    ++state_.sequence;
  }
  state_.utime = participant_.clock().Utime();
  state_.tick = tick_;
  state_.session = participant_.session();
  state_.time = static_cast<double>(tick_) / config_.plant.rate_hz;
  state_.skipped_ticks = skipped_ticks;
  if (asks_pressure_ && !participant_.simulated()) {
    now = participant_.clock().Now();
    round_trips_.OnSent(tick_, now);
  }
  state_publisher_.Send(state_);
  return now;
}

// The role whose answer the plant still awaits at this tick; null when all have answered.
inline const char* PlantApp::Unanswered() const {
  if (asks_position_ && newest_pressure_command_tick_ < tick_) return "position_ctrl";
  if (asks_pressure_ && newest_command_tick_ < tick_) return "pressure_ctrl";
  return log_progress_.empty() || LoggersKeepUp() ? nullptr : "logger";
}

// Polls everything that is due now.
inline void PlantApp::PollIfDue(bus::Clock::TimePoint now) {
  const bool due = participant_.IsDue(now) || tuning_.IsDue(now) || now >= next_description_ ||
                   LostMessages() != participant_.statistics().lost_messages();
  if (due) PollDue(now);
}

// Whether a participant has left the run, or `who` (null: nobody) has not answered in time.
inline bool PlantApp::Fails(const char* who, bool late) const {
  return (who != nullptr && late) || (!roll_call_.left().empty() && !participant_.stop());
}

void PlantApp::RunLockstep() {
  const bool simulated = participant_.simulated();
  const auto start = participant_.clock().Now();
  const double rate = config_.plant.rate_hz;
  Measure(0);
  auto now = Publish(0, start);
  while (AwaitAnswers(&now) && tick_ != config_.last_tick) {
    Check(now);
    ChooseVoltage();
    Drive();
    if (participant_.stop()) break;  // a limit was exceeded
    Advance(tick_ + 1);
    if (simulated) {
      // No other process advances simulated time. The due time of each tick is computed from the start, so
      // that rounding does not add up.
      const auto due = start + bus::FromSeconds(static_cast<double>(tick_) / rate);
      while (participant_.bus().HandleUntil(due) > 0) {
      }
    }
    const auto woke = participant_.clock().Now();
    now = Publish(0, woke);
    if (simulated) continue;
    now = participant_.clock().Now();
    participant_.statistics().RecordCycle(woke, now - woke);
  }
}

// Waits from `*now` on, and sets `*now` to the time at which it went on. Returns false when the run has
// ended.
bool PlantApp::AwaitAnswers(bus::Clock::TimePoint* now) {
  if (Unanswered() == nullptr) return true;
  const auto deadline = *now + stall_time_;
  auto next_repeat = *now + kStateRepeatPeriod;
  while (!Ended()) {
    participant_.bus().HandleUntil(std::min(next_repeat, deadline));
    const char* const who = Unanswered();
    *now = participant_.clock().Now();
    if (Fails(who, *now >= deadline)) {
      RequestStopFor(who);
      return false;
    }
    if (who != nullptr && *now >= next_repeat) {
      state_publisher_.Send(state_);  // the state or its answer may have been lost
      next_repeat = *now + kStateRepeatPeriod;
    }
    PollIfDue(*now);
    if (who == nullptr) return !Ended();
  }
  return false;
}

void PlantApp::RequestStopFor(const char* who) {
  const bool left = !roll_call_.left().empty() && !participant_.stop();
  participant_.RequestStop(
      left ? fmt::format("{} has left the lockstep run at tick {}", roll_call_.left(), tick_)
           : fmt::format("{} has not answered tick {} within {} s (time.stall_timeout_s)", who, tick_,
                         config_.time.stall_timeout_s),
      1);
}

bool PlantApp::LoggersKeepUp() const {
  return std::none_of(log_progress_.begin(), log_progress_.end(),
                      [&](const auto& logger) { return logger.second < tick_ - kLoggerWindowTicks; });
}

bus::Clock::TimePoint PlantApp::Wake(const WakeUp& wake_up) {
  const int64_t elapsed = wake_up.elapsed;
  participant_.statistics().set_missed_deadlines(wake_up.skipped);
  const double slept = static_cast<double>(elapsed - 1) / (config_.plant.rate_hz * config_.time.speed);
  Advance(tick_ + elapsed);  // under the voltage that was held during all of these ticks
  if (bus::FromSeconds(slept) > stale_time_) awake_again_ = tick_;
  return Publish(elapsed - 1, wake_up.at);
}

void PlantApp::RunRealtime() {
  if (pacemaker_ != nullptr) return RunAtThePaceOf(*pacemaker_);
  const std::chrono::duration<double> period(1 / (config_.plant.rate_hz * config_.time.speed));
  timing::FixedRateLoop loop(participant_.bus(), participant_.clock(), period, participant_.statistics(),
                             config_.last_tick);
  Measure(0);
  Publish(0, loop.woke());
  while (!Ended() && tick_ != config_.last_tick) {
    const int64_t elapsed = loop.Wait();
    if (elapsed == 0) continue;  // interrupted by a signal
    const auto now = Wake({elapsed, loop.skipped(), loop.woke(), loop.late()});
    Check(now);
    ChooseVoltage();
    Drive();
    logger_watch_.Poll(now);
    PollIfDue(now);
  }
}

void PlantApp::RunAtThePaceOf(Pacemaker& device) {
  const std::chrono::duration<double> period(1 / config_.plant.rate_hz);
  timing::FollowedRateLoop loop(participant_.clock(), period, participant_.statistics(), config_.last_tick);
  Measure(0);
  Publish(0, loop.woke());
  Check(loop.woke());
  while (tick_ != config_.last_tick) {
    const int64_t elapsed = AwaitSample(device, loop);
    if (elapsed == 0) return;  // the run has ended
    const auto now = Wake({elapsed, loop.skipped(), loop.woke(), loop.late()});
    Check(now);
    logger_watch_.Poll(now);
    PollIfDue(now);
  }
}

// The voltage goes out with the answer to this tick, or at once when no answer is awaited. Without an answer,
// the command in force is repeated when the next sample has come, so that the device hears from this process
// in each tick.
int64_t PlantApp::AwaitSample(Pacemaker& device, timing::FollowedRateLoop& loop) {
  bus::Bus& bus = participant_.bus();
  int64_t elapsed = 0;
  for (bool driven = false; elapsed == 0 && !Ended();) {
    bus.WakeOn(device.descriptor());
    const int handled = AwaitsAnswer() || driven ? bus.HandleUntil(loop.deadline()) : 0;
    bus.WakeOn(-1);
    if (handled > 0) participant_.statistics().RecordQueueDepth(handled);
    const auto arrived = device.Arrived();
    const auto now = participant_.clock().Now();
    elapsed = loop.Elapsed(now, arrived);
    if (driven || (elapsed == 0 && AwaitsAnswer())) continue;
    Check(now);
    ChooseVoltage();
    Drive();
    driven = true;
  }
  return elapsed;
}

// Awaits nothing while something is wrong: zero volts go out first.
bool PlantApp::AwaitsAnswer() const {
  return asks_pressure_ && newest_command_tick_ < tick_ && !safety_.holds() && rig_.faults().empty();
}

// The same steps, for programs that pace the run themselves.
void PlantApp::Start() {
  Measure(0);
  Publish(0, participant_.clock().Now());
}

void PlantApp::AdvanceTo(int64_t tick) { Advance(tick); }
void PlantApp::PublishState() { Publish(0, participant_.clock().Now()); }
void PlantApp::Poll(bus::Clock::TimePoint now) { PollIfDue(now); }

bool PlantApp::AwaitAnswers() {
  auto now = participant_.clock().Now();
  return AwaitAnswers(&now);
}

}  // namespace hydro::plant
