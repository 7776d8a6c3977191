#include "plant/plant_pace.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "plant/plant_app.h"
#include "process/timing/fixed_rate_loop.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr auto kStateRepeatPeriod = 100ms;  // lockstep: how often an unanswered state is sent again

}  // namespace

PlantPace::PlantPace(PlantApp& plant, const settings::StackConfig& config, Pacemaker* pacemaker)
    : plant_(plant),
      pacemaker_(pacemaker),
      lockstep_(config.time.mode == settings::TimeMode::kLockstep),
      rate_(config.plant.rate_hz),
      speed_(config.time.speed),
      last_tick_(config.last_tick),
      stall_timeout_s_(config.time.stall_timeout_s) {}

void PlantPace::Run() {
  if (lockstep_) {
    RunLockstep();
  } else if (pacemaker_ != nullptr) {
    RunAtThePaceOf(*pacemaker_);
  } else {
    RunRealtime();
  }
}

inline void PlantPace::CheckAndDrive(bus::Clock::TimePoint now) {
  plant_.Check(now);
  plant_.ChooseVoltage();
  plant_.Drive();
}

void PlantPace::RunLockstep() {
  process::Participant& participant = plant_.participant();
  const bool simulated = participant.simulated();
  const auto start = participant.clock().Now();
  auto now = plant_.Start(start);
  while (AwaitAnswers(&now) && plant_.tick() != last_tick_) {
    CheckAndDrive(now);
    if (participant.stop()) break;  // a limit was exceeded
    plant_.AdvanceTo(plant_.tick() + 1);
    if (simulated) {
      // No other process advances simulated time. The due time of each tick is computed from the start, so
      // that rounding does not add up.
      const auto due = start + bus::FromSeconds(static_cast<double>(plant_.tick()) / rate_);
      while (participant.bus().HandleUntil(due) > 0) {
      }
    }
    const auto woke = participant.clock().Now();
    now = plant_.PublishState(woke);
    if (simulated) continue;
    now = participant.clock().Now();
    participant.statistics().RecordCycle(woke, now - woke);
  }
}

bool PlantPace::AwaitAnswers(bus::Clock::TimePoint* now) {
  if (plant_.Unanswered() == nullptr) return true;
  process::Participant& participant = plant_.participant();
  const auto deadline = *now + bus::FromSeconds(stall_timeout_s_);
  auto next_repeat = *now + kStateRepeatPeriod;
  while (!plant_.Ended()) {
    participant.bus().HandleUntil(std::min(next_repeat, deadline));
    const char* const who = plant_.Unanswered();
    *now = participant.clock().Now();
    if ((who != nullptr && *now >= deadline) || plant_.IsDeserted()) {
      RequestStopFor(who);
      return false;
    }
    if (who != nullptr && *now >= next_repeat) {
      plant_.RepeatState();  // the state or its answer may have been lost
      next_repeat = *now + kStateRepeatPeriod;
    }
    plant_.Poll(*now);
    if (who == nullptr) return !plant_.Ended();
  }
  return false;
}

void PlantPace::RequestStopFor(const char* who) {
  plant_.participant().RequestStop(
      plant_.IsDeserted() ? plant_.start().Departure(plant_.tick())
                          : fmt::format("{} has not answered tick {} within {} s (time.stall_timeout_s)", who,
                                        plant_.tick(), stall_timeout_s_),
      1);
}

void PlantPace::RunRealtime() {
  process::Participant& participant = plant_.participant();
  const std::chrono::duration<double> period(1 / (rate_ * speed_));
  timing::FixedRateLoop loop(participant.bus(), participant.clock(), period, participant.statistics(),
                             last_tick_);
  plant_.Start(loop.woke());
  while (!plant_.Ended() && plant_.tick() != last_tick_) {
    const int64_t elapsed = loop.Wait();
    if (elapsed == 0) continue;  // interrupted by a signal
    const auto now = plant_.Wake({elapsed, loop.skipped(), loop.woke(), loop.late()});
    CheckAndDrive(now);
    plant_.WatchLoggers(now);
    plant_.Poll(now);
  }
}

void PlantPace::RunAtThePaceOf(Pacemaker& device) {
  process::Participant& participant = plant_.participant();
  const std::chrono::duration<double> period(1 / rate_);
  timing::FollowedRateLoop loop(participant.clock(), period, participant.statistics(), last_tick_);
  plant_.Start(loop.woke());
  plant_.Check(loop.woke());
  while (plant_.tick() != last_tick_) {
    const int64_t elapsed = AwaitSample(device, loop);
    if (elapsed == 0) return;  // the run has ended
    const auto now = plant_.Wake({elapsed, loop.skipped(), loop.woke(), loop.late()});
    plant_.Check(now);
    plant_.WatchLoggers(now);
    plant_.Poll(now);
  }
}

// The voltage goes out with the answer to this tick, or at once when no answer is awaited. Without an answer,
// the command in force is repeated when the next sample has come, so that the device hears from this process
// in each tick.
int64_t PlantPace::AwaitSample(Pacemaker& device, timing::FollowedRateLoop& loop) {
  process::Participant& participant = plant_.participant();
  bus::Bus& bus = participant.bus();
  int64_t elapsed = 0;
  for (bool driven = false; elapsed == 0 && !plant_.Ended();) {
    bus.WakeOn(device.descriptor());
    const int handled = plant_.AwaitsMotorCommand() || driven ? bus.HandleUntil(loop.deadline()) : 0;
    bus.WakeOn(-1);
    if (handled > 0) participant.statistics().RecordQueueDepth(handled);
    const auto arrived = device.Arrived();
    const auto now = participant.clock().Now();
    elapsed = loop.Elapsed(now, arrived);
    if (driven || (elapsed == 0 && plant_.AwaitsMotorCommand())) continue;
    CheckAndDrive(now);
    driven = true;
  }
  return elapsed;
}

}  // namespace hydro::plant
