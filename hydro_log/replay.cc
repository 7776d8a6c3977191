#include "hydro_log/replay.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <thread>
#include <vector>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/saturating.h"
#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "hydro_log/record_gap.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "runs/compare.h"
#include "runs/tuning_history.h"
#include "settings/stack_config.h"

namespace hydro::hydro_log {
namespace {

constexpr double kLatestTime = 1e9;  // s; 64 bits of ns hold it

// The first message of each tick: a later one of the same tick is a repetition or comes from a watchdog.
template <class Message>
std::map<int64_t, Message> ByTick(const std::vector<Message>& messages) {
  std::map<int64_t, Message> by_tick;
  for (const Message& message : messages) by_tick.emplace(message.tick, message);
  return by_tick;
}

template <class Message>
std::vector<Message> Unnumbered(const std::map<int64_t, Message>& by_tick) {
  std::vector<Message> messages;
  for (const auto& [tick, message] : by_tick) {
    messages.push_back(message);
    messages.back().sequence = 0;
  }
  return messages;
}

class Replayer {
 public:
  // `role`: of the process that is replayed.
  Replayer(const runs::RunLog& log, double speed, const std::string& role) : speed_(speed) {
    if (log.messages.Of<run_description_t>().empty()) {
      throw InputError(log.file +
                       ": found no HYDRO_RUN message; a replay needs the run's configuration and model");
    }
    const run_description_t& description = log.messages.Of<run_description_t>().front();
    if (description.config_text.empty()) {
      throw InputError(
          log.file + ": its description has no configuration (an imported table); a replay needs the run's");
    }
    config_ = settings::ParseStackConfig(description.config_text, log.file + " (its configuration)",
                                         description.model_text, log.file + " (its model)");
    config_.time.mode =
        settings::TimeMode::kRealtime;  // nothing waits: what is in force is handed over in time
    channels_ = bus::Channels(config_.bus.channel_suffix);
    states_ = ByTick(log.messages.Of<state_t>());
    if (states_.empty()) throw InputError(log.file + ": found no states to feed");
    for (tuned_settings_t settings : runs::TuningHistory(log.messages)) {
      settings.acts_at = runs::EffectTick(log.messages, settings, role);
      settings.stage = tuned_settings_t::DECIDED;
      tunings_.push_back(std::move(settings));
    }
    ReadPlans(log.messages.Of<arm_plan_t>());
    if (role == "position_ctrl") {
      faults_ = log.messages.Of<fault_t>();
      active_faults_ = log.messages.Of<active_faults_t>();
      statuses_ = log.messages.Of<process_status_t>();
    }
    for (const auto& [tick, state] : states_) {
      if (std::abs(state.time) <= kLatestTime) continue;
      throw InputError(log.file + ": found the state of tick " + std::to_string(tick) + " at " +
                       NumberText(state.time) + " s; a time between -1e9 and 1e9 s is needed");
    }
  }

  const settings::StackConfig& config() const { return config_; }
  const bus::Channels& channels() const { return channels_; }
  bus::SimulatedClock& clock() { return clock_; }
  bus::InProcessBus& bus() { return bus_; }
  int64_t first_tick() const { return states_.begin()->first; }
  std::optional<int64_t> FirstGap() const { return FirstMissingState(states_); }
  int64_t states() const { return static_cast<int64_t>(states_.size()); }

  // Sends the states one by one; `before` may send something else first.
  template <class Before>
  void Feed(Before before) {
    auto next = tunings_.begin();
    auto plan = plans_.begin();
    const double first_time = states_.begin()->second.time;
    const auto wall_start = std::chrono::steady_clock::now();
    for (const auto& [tick, state] : states_) {
      const std::chrono::duration<double> elapsed(state.time - first_time);
      if (speed_ > 0) std::this_thread::sleep_until(wall_start + elapsed / speed_);
      clock_.AdvanceTo(bus::Clock::TimePoint(std::chrono::duration_cast<bus::Clock::Duration>(elapsed)));
      before(tick);
      Overtake(state.utime, faults_, &next_fault_);
      Overtake(state.utime, active_faults_, &next_active_);
      Overtake(state.utime, statuses_, &next_status_);
      for (; plan != plans_.end() && plan->first < tick; ++plan) {
        bus_.Publish(channels_.Of<arm_plan_t>(), plan->second);
        Deliver();
      }
      for (; next != tunings_.end() && next->acts_at <= tick; ++next) {
        bus_.Publish(channels_.Of<tuned_settings_t>(), *next);
        Deliver();
      }
      bus_.Publish(channels_.Of<state_t>(), state);
      Deliver();
    }
  }

  void Deliver() {
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

 private:
  // What other processes said before the state was sent: the position loop holds its reference while the pressure loop has a fault.
  template <class Message>
  void Overtake(int64_t utime, const std::vector<Message>& messages, size_t* next) {
    for (; *next < messages.size() && messages[*next].utime < utime; ++*next) {
      bus_.Publish(channels_.Of<Message>(), messages[*next]);
      Deliver();
    }
  }

  // A plan acts by the tick that it names, so it is handed over behind that one's state; without a tick, behind the last state that was sent
  // before it (by the clocks of both).
  void ReadPlans(const std::vector<arm_plan_t>& plans) {
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

  double speed_;
  settings::StackConfig config_;
  bus::Channels channels_;
  std::map<int64_t, state_t> states_;
  std::vector<fault_t> faults_;
  std::vector<active_faults_t> active_faults_;
  std::vector<process_status_t> statuses_;
  size_t next_fault_ = 0, next_active_ = 0, next_status_ = 0;
  std::vector<std::pair<int64_t, arm_plan_t>> plans_;  // behind which tick
  std::vector<tuned_settings_t> tunings_;  // acts_at: from when the replayed process acted by them
  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
};

ReplayResult Compare(const Replayer& replayer, const runs::RunMessages& recorded,
                     const runs::RunMessages& replayed, size_t answers) {
  ReplayResult result;
  result.states = replayer.states();
  result.answers = static_cast<int64_t>(answers);
  result.difference = runs::FirstDifference(recorded, "the record", replayed, "the replay");
  return result;
}

ReplayResult WithGap(ReplayResult result, std::optional<int64_t> gap, int64_t not_compared) {
  result.gap_tick = gap;
  result.not_compared = not_compared;
  return result;
}

// Takes the commands from tick `gap` on out of the comparison and returns how many those were.
template <class Commands>
int64_t CutAt(const std::optional<int64_t>& gap, Commands& commands) {
  if (!gap) return 0;
  const auto from = commands.lower_bound(*gap);
  const auto count = std::distance(from, commands.end());
  commands.erase(from, commands.end());
  return count;
}

ReplayResult ReplayPressure(const runs::RunLog& log, double speed) {
  std::map<int64_t, motor_command_t> recorded;
  for (const auto& [tick, command] : ByTick(log.messages.Of<motor_command_t>())) {
    if (command.status != motor_command_t::STOPPED) recorded.emplace(tick, command);
  }
  if (recorded.empty()) throw InputError(log.file + ": found no motor commands to compare with");
  const auto pressure_commands = ByTick(log.messages.Of<pressure_command_t>());
  // In a log that begins in the middle of a run, the pressure command then in force was sent before.
  while (!recorded.empty() && recorded.begin()->second.pressure_command_tick >= 0 &&
         !pressure_commands.contains(recorded.begin()->second.pressure_command_tick)) {
    recorded.erase(recorded.begin());
  }

  Replayer replayer(log, speed, "pressure_ctrl");
  std::optional<int64_t> gap = replayer.FirstGap();
  if (const auto lost = FirstWithoutPressureCommand(recorded, pressure_commands);
      lost && (!gap || *lost < *gap)) {
    gap = lost;
  }
  const int64_t not_compared = CutAt(gap, recorded);
  pressure_ctrl::PressureApp app(replayer.bus(), replayer.clock(), replayer.config());
  std::map<int64_t, motor_command_t> answers;
  replayer.bus().Subscribe<motor_command_t>(replayer.channels().Of<motor_command_t>(),
                                            [&](const motor_command_t& command) {
                                              if (recorded.contains(command.tick))
                                                answers.emplace(command.tick, command);
                                            });
  auto next = pressure_commands.begin();
  replayer.Feed([&](int64_t tick) {
    const auto command = recorded.find(tick);
    if (command == recorded.end()) return;
    for (; next != pressure_commands.end() && next->first <= command->second.pressure_command_tick; ++next) {
      replayer.bus().Publish(replayer.channels().Of<pressure_command_t>(), next->second);
      replayer.Deliver();
    }
  });
  runs::RunMessages record, replay;
  record.Of<motor_command_t>() = Unnumbered(recorded);
  replay.Of<motor_command_t>() = Unnumbered(answers);
  return WithGap(Compare(replayer, record, replay, recorded.size()), gap, not_compared);
}

ReplayResult ReplayPosition(const runs::RunLog& log, double speed) {
  auto recorded = ByTick(log.messages.Of<pressure_command_t>());
  auto references = ByTick(log.messages.Of<arm_reference_t>());
  if (recorded.empty()) throw InputError(log.file + ": found no pressure commands to compare with");

  Replayer replayer(log, speed, "position_ctrl");
  if (replayer.first_tick() > 0) {
    // In a log that begins in the middle of a run, the derivative of the first sample needs the sample
    // before.
    const int64_t interval = replayer.config().position_interval_ticks;
    const int64_t since_sample = replayer.first_tick() % interval;
    const int64_t first_sample = since_sample == 0
                                     ? replayer.first_tick()
                                     : SaturatingSum(replayer.first_tick(), interval - since_sample);
    recorded.erase(recorded.begin(), recorded.upper_bound(first_sample));
    references.erase(references.begin(), references.upper_bound(first_sample));
  }
  const std::optional<int64_t> gap = replayer.FirstGap();
  const int64_t not_compared = CutAt(gap, recorded);
  CutAt(gap, references);
  position_ctrl::PositionApp app(replayer.bus(), replayer.clock(), replayer.config());
  std::map<int64_t, pressure_command_t> answers;
  std::map<int64_t, arm_reference_t> answered_references;
  replayer.bus().Subscribe<pressure_command_t>(replayer.channels().Of<pressure_command_t>(),
                                               [&](const auto& command) {
                                                 if (recorded.contains(command.tick))
                                                   answers.emplace(command.tick, command);
                                               });
  replayer.bus().Subscribe<arm_reference_t>(replayer.channels().Of<arm_reference_t>(),
                                            [&](const auto& reference) {
                                              if (references.contains(reference.tick))
                                                answered_references.emplace(reference.tick, reference);
                                            });
  replayer.Feed([](int64_t) {});
  runs::RunMessages record, replay;
  record.Of<pressure_command_t>() = Unnumbered(recorded);
  record.Of<arm_reference_t>() = Unnumbered(references);
  replay.Of<pressure_command_t>() = Unnumbered(answers);
  replay.Of<arm_reference_t>() = Unnumbered(answered_references);
  return WithGap(Compare(replayer, record, replay, recorded.size()), gap, not_compared);
}

}  // namespace

ReplayResult Replay(const runs::RunLog& log, ReplayedController controller, double speed) {
  return controller == ReplayedController::kPressure ? ReplayPressure(log, speed)
                                                     : ReplayPosition(log, speed);
}

}  // namespace hydro::hydro_log
