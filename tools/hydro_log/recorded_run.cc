#include "tools/hydro_log/recorded_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <hydro/pressure_command_t.hpp>
#include <thread>

#include "base/input_error.h"
#include "base/number_text.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/tuning_history.h"
#include "tools/hydro_log/record_gap.h"

namespace hydro::hydro_log {
namespace {

constexpr double kLatestTime = 1e9;  // s; 64 bits of ns can hold it

}  // namespace

std::map<int64_t, motor_command_t> RecordedMotorCommands(const runs::RunLog& log) {
  std::map<int64_t, motor_command_t> recorded;
  for (const auto& [tick, command] : ByTick(log.messages.Of<motor_command_t>())) {
    if (command.status != motor_command_t::STOPPED) recorded.emplace(tick, command);
  }
  if (recorded.empty()) throw InputError(log.file + ": found no motor commands to compare with");
  const auto pressure_commands = ByTick(log.messages.Of<pressure_command_t>());
  while (!recorded.empty() && recorded.begin()->second.pressure_command_tick >= 0 &&
         !pressure_commands.contains(recorded.begin()->second.pressure_command_tick)) {
    recorded.erase(recorded.begin());
  }
  return recorded;
}

RecordedRun::RecordedRun(const runs::RunLog& log, const std::string& role) {
  if (log.messages.Of<run_description_t>().empty()) {
    throw InputError(log.file +
                     ": found no HYDRO_RUN message; a replay needs the run's configuration and model");
  }
  description_ = log.messages.Of<run_description_t>().front();
  if (description_.config_text.empty()) {
    throw InputError(log.file +
                     ": its description has no configuration (an imported table); a replay needs the run's");
  }
  runs::RequireReadable(description_, log.file);
  config_ = settings::ParseStackConfig(description_.config_text, log.file + " (its configuration)",
                                       description_.model_text, log.file + " (its model)");
  config_.time.mode =
      settings::TimeMode::kRealtime;  // nothing waits, because what is in force is handed over in time
  states_ = ByTick(log.messages.Of<state_t>());
  if (states_.empty()) throw InputError(log.file + ": found no states to feed");
  runs::RequireEveryState(log, "a replay");
  for (const auto& [tick, state] : states_) {
    if (std::abs(state.time) <= kLatestTime) continue;
    throw InputError(log.file + ": found the state of tick " + std::to_string(tick) + " at " +
                     NumberText(state.time) + " s; a time between -1e9 and 1e9 s is needed");
  }
  ReadOthers(log, role);
}

void RecordedRun::ReadOthers(const runs::RunLog& log, const std::string& role) {
  for (tuned_settings_t settings : runs::TuningHistory(log.messages)) {
    settings.acts_at = runs::EffectTick(log.messages, settings, role);
    settings.stage = tuned_settings_t::DECIDED;
    tunings_.push_back(std::move(settings));
  }
  ReadPlans(log.messages.Of<arm_plan_t>());
  if (role != "position_ctrl") return;
  faults_ = log.messages.Of<fault_t>();
  active_faults_ = log.messages.Of<active_faults_t>();
  statuses_ = log.messages.Of<process_status_t>();
}

std::optional<int64_t> RecordedRun::FirstGap() const { return FirstMissingState(states_); }

void RecordedRun::Feed(bus::Bus& bus, const bus::Channels& channels, double speed, const Steps& steps) {
  auto next = tunings_.begin();
  auto plan = plans_.begin();
  const double first_time = states_.begin()->second.time;
  const auto wall_start = std::chrono::steady_clock::now();
  for (const auto& [tick, state] : states_) {
    const std::chrono::duration<double> elapsed(state.time - first_time);
    if (speed > 0) std::this_thread::sleep_until(wall_start + elapsed / speed);
    steps.advance(elapsed.count());
    steps.before(tick);
    Overtake(bus, channels, state.utime, steps, faults_, &next_fault_);
    Overtake(bus, channels, state.utime, steps, active_faults_, &next_active_);
    Overtake(bus, channels, state.utime, steps, statuses_, &next_status_);
    for (; plan != plans_.end() && plan->first < tick; ++plan) {
      bus.Publish(channels.Of<arm_plan_t>(), plan->second);
      steps.deliver();
    }
    for (; next != tunings_.end() && next->acts_at <= tick; ++next) {
      bus.Publish(channels.Of<tuned_settings_t>(), *next);
      steps.deliver();
    }
    bus.Publish(channels.Of<state_t>(), state);
    steps.deliver();
    if (!steps.answer(state)) return;
  }
}

// Sends what other processes had sent before the state. This matters because the position loop holds its
// reference while the pressure loop has a fault.
template <class Message>
void RecordedRun::Overtake(bus::Bus& bus, const bus::Channels& channels, int64_t utime, const Steps& steps,
                           const std::vector<Message>& messages, size_t* next) {
  for (; *next < messages.size() && messages[*next].utime < utime; ++*next) {
    bus.Publish(channels.Of<Message>(), messages[*next]);
    steps.deliver();
  }
}

// A plan acts from the tick that it names, so it is handed over after the state of that tick. A plan without
// a tick is handed over after the last state that was sent before it (according to the clocks of both
// senders).
void RecordedRun::ReadPlans(const std::vector<arm_plan_t>& plans) {
  for (const arm_plan_t& plan : plans) {
    int64_t behind = plan.tick;
    if (behind < 0) {
      for (const auto& [tick, state] : states_) {
        if (state.utime > plan.utime) break;
        behind = tick;
      }
    }
    plans_.emplace_back(behind, plan);
  }
  std::stable_sort(plans_.begin(), plans_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

}  // namespace hydro::hydro_log
