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
  const bool simulated = participant_.clock().simulated();
  const auto start = participant_.clock().Now();
  const double rate = config_.plant.rate_hz;
  Start();
  while (AwaitAnswers() && tick_ != config_.last_tick) {
    Check();
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

bool PlantApp::AwaitAnswers() {
  if (Unanswered().empty()) return true;
  bus::Bus& bus = participant_.bus();
  const bus::Clock& clock = participant_.clock();
  auto now = clock.Now();
  const auto deadline = now + bus::FromSeconds(config_.time.stall_timeout_s);
  auto next_repeat = now + kRepeatPeriod;
  while (!Ended()) {
    bus.HandleUntil(std::min(next_repeat, deadline));
    if (!roll_call_.left().empty() && !participant_.stop()) {
      participant_.RequestStop(
          fmt::format("{} has left the lockstep run at tick {}", roll_call_.left(), tick_), 1);
      return false;
    }
    const std::string who = Unanswered();
    now = clock.Now();
    if (who.empty()) {
      Poll();
      return !Ended();
    }
    if (now >= deadline) {
      participant_.RequestStop(fmt::format("{} has not answered tick {} within {} s (time.stall_timeout_s)",
                                           who, tick_, config_.time.stall_timeout_s),
                               1);
      return false;
    }
    if (now >= next_repeat) {
      state_publisher_.Send(state_);  // the state or its answer may have been lost
      next_repeat = now + kRepeatPeriod;
    }
    Poll();
  }
  return false;
}

// The role that the plant still waits for at this tick; empty when all have answered.
std::string PlantApp::Unanswered() const {
  if (tick_ % config_.position_interval_ticks == 0 && newest_pressure_command_tick_ < tick_) {
    return "position_ctrl";
  }
  if (tick_ % config_.pressure_interval_ticks == 0 && newest_command_tick_ < tick_) return "pressure_ctrl";
  for (const auto& [session, tick] : log_progress_) {
    if (tick < tick_ - kLoggerWindowTicks) return "logger";
  }
  return "";
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
    Check();
    ChooseVoltage();
    Drive();
    logger_watch_.Poll();
    Poll();
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
