// PlantApp's two ways to pace a run: lockstep, which waits for every answer, and real time, which waits for
// none.
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "plant/plant_app.h"
#include "timing/fixed_rate_loop.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr auto kRepeatPeriod = 100ms;  // lockstep: how often an unanswered state is sent again
// Lockstep: how far the plant may run ahead of a logger; about half of what Linux's default receive buffer
// (208 KiB) holds.
constexpr int64_t kLoggerWindowTicks = 64;

}  // namespace

void PlantApp::RunLockstep() {
  const bool simulated = participant_.simulated();
  const auto start = participant_.clock().Now();
  const double rate = config_.plant.rate_hz;
  Start();
  while (AwaitAnswers() && tick_ != config_.last_tick) {
    Check(participant_.clock().Now());
    ChooseVoltage();
    Drive();
    if (participant_.stop()) break;  // a limit was exceeded
    Advance(tick_ + 1);
    if (simulated) {
      // Nobody else advances simulated time. Each tick is computed from the start, so that rounding does not
      // add up.
      const auto due = start + bus::FromSeconds(static_cast<double>(tick_) / rate);
      while (participant_.bus().HandleUntil(due) > 0) {
      }
    }
    const auto woke = participant_.clock().Now();
    PublishState(0);
    if (!simulated) participant_.statistics().RecordCycle(woke, participant_.clock().Now() - woke);
  }
}

// False: the run has ended.
bool PlantApp::AwaitAnswers() {
  if (Unanswered() == nullptr) return true;
  const auto start = participant_.clock().Now();
  const auto deadline = start + stall_time_;
  auto next_repeat = start + kRepeatPeriod;
  while (!Ended()) {
    participant_.bus().HandleUntil(std::min(next_repeat, deadline));
    const char* const who = Unanswered();
    const auto now = participant_.clock().Now();
    if (!MayGoOn(who, now >= deadline)) return false;
    if (who != nullptr && now >= next_repeat) {
      state_publisher_.Send(state_);  // the state or its answer may have been lost
      next_repeat = now + kRepeatPeriod;
    }
    Poll(now);
    if (who == nullptr) return !Ended();
  }
  return false;
}

// Ends the run when a participant has left it, or `who` (null: nobody) has not answered in time. True: it goes on.
bool PlantApp::MayGoOn(const char* who, bool late) {
  if (!roll_call_.left().empty() && !participant_.stop()) {
    participant_.RequestStop(
        fmt::format("{} has left the lockstep run at tick {}", roll_call_.left(), tick_), 1);
    return false;
  }
  if (who == nullptr || !late) return true;
  participant_.RequestStop(fmt::format("{} has not answered tick {} within {} s (time.stall_timeout_s)", who,
                                       tick_, config_.time.stall_timeout_s),
                           1);
  return false;
}

// The role that the plant still waits for at this tick; null when all have answered.
const char* PlantApp::Unanswered() const {
  if (asks_position_ && newest_pressure_command_tick_ < tick_) return "position_ctrl";
  if (asks_pressure_ && newest_command_tick_ < tick_) return "pressure_ctrl";
  return log_progress_.empty() || LoggersKeepUp() ? nullptr : "logger";
}

bool PlantApp::LoggersKeepUp() const {
  return std::none_of(log_progress_.begin(), log_progress_.end(),
                      [&](const auto& logger) { return logger.second < tick_ - kLoggerWindowTicks; });
}

void PlantApp::RunRealtime() {
  const std::chrono::duration<double> period(1 / (config_.plant.rate_hz * config_.time.speed));
  timing::FixedRateLoop loop(participant_.bus(), participant_.clock(), period, participant_.statistics(),
                             config_.last_tick);
  Start();
  while (!Ended() && tick_ != config_.last_tick) {
    const int64_t elapsed = loop.Wait();
    if (elapsed == 0) continue;  // interrupted by a signal
    Wake({elapsed, loop.skipped(), loop.woke(), loop.late()});
    const auto now = participant_.clock().Now();
    Check(now);
    ChooseVoltage();
    Drive();
    logger_watch_.Poll(now);
    Poll(now);
  }
}

void PlantApp::Wake(const WakeUp& wake_up) {
  const int64_t elapsed = wake_up.elapsed;
  participant_.statistics().set_missed_deadlines(wake_up.skipped);
  const double slept = static_cast<double>(elapsed - 1) / (config_.plant.rate_hz * config_.time.speed);
  Advance(tick_ + elapsed);  // under the voltage that was held all that time
  if (bus::FromSeconds(slept) > stale_time_) awake_again_ = tick_;
  PublishState(elapsed - 1);
}

}  // namespace hydro::plant
