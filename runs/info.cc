#include "runs/info.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "base/input_error.h"
#include "base/integers.h"
#include "base/units.h"
#include "bus/channels.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/senders.h"

namespace hydro::runs {
namespace {

double Seconds(int64_t first_utime, int64_t last_utime) {
  return (static_cast<double>(last_utime) - static_cast<double>(first_utime)) * 1e-6;
}

// One channel's sequence numbers, by sender.
class SequenceCount {
 public:
  template <class Message>
  explicit SequenceCount(const std::vector<Message>& messages) {
    for (const Message& message : messages) sequences_[message.session].push_back(message.sequence);
  }

  void Fill(ChannelInfo& info) {
    info.numbered = true;
    info.senders = static_cast<int64_t>(sequences_.size());
    for (auto& [session, numbers] : sequences_) {
      const auto count = static_cast<int64_t>(numbers.size());
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
      const auto distinct = static_cast<int64_t>(numbers.size());
      info.repeated += count - distinct;
      info.missing = SaturatingSum(
          info.missing,
          SaturatingDifference(SaturatingDifference(numbers.back(), numbers.front()), distinct - 1));
      info.before_first = SaturatingSum(info.before_first, std::max<int64_t>(numbers.front(), 0));
    }
  }

 private:
  std::map<int64_t, std::vector<int64_t>> sequences_;
};

ChannelInfo ChannelOf(const ChannelSummary& summary, const RunLog& log) {
  ChannelInfo info;
  info.summary = summary;
  const double seconds = Seconds(summary.first_utime, summary.last_utime) -
                         SecondsOfSteps(log.clock_steps, summary.first_event, summary.last_event);
  if (summary.events > 1 && seconds > 0) info.rate_hz = static_cast<double>(summary.events - 1) / seconds;
  const bus::Channels channels(log.suffix);
  bus::AnyMessage([&]<class Message>(const bus::MessageRow<Message>&) {
    if (summary.channel != channels.Of<Message>()) return false;
    if constexpr (bus::PlacesOf<Message>().sequence >= 0) {
      SequenceCount(log.messages.Of<Message>()).Fill(info);
    }
    return true;
  });
  return info;
}

TickInfo TicksOf(const RunMessages& messages) {
  const std::vector<state_t>& states = messages.Of<state_t>();
  std::map<int64_t, const state_t*> by_tick;
  for (const state_t& state : states) by_tick.try_emplace(by_tick.end(), state.tick, &state);
  TickInfo info;
  info.states = static_cast<int64_t>(by_tick.size());
  if (by_tick.empty()) return info;
  info.first = by_tick.begin()->first;
  info.last = by_tick.rbegin()->first;
  info.first_time_s = by_tick.begin()->second->time;
  info.last_time_s = by_tick.rbegin()->second->time;
  if (info.last_time_s > info.first_time_s) {
    info.rate_hz = static_cast<double>(SaturatingDifference(info.last, info.first)) /
                   (info.last_time_s - info.first_time_s);
  }
  info.sampled = SampleTicks(messages);
  const int64_t left_out = info.sampled - 1;  // ticks left out on purpose between two samples
  int64_t previous = info.first;
  for (const auto& [tick, state] : by_tick) {
    const int64_t between =
        std::max<int64_t>(0, SaturatingDifference(SaturatingDifference(tick, previous), 1));
    const int64_t announced = std::clamp<int64_t>(state->skipped_ticks, 0, between);
    // A sample of a late tick is itself late, so there is a gap only where at least one further interval is
    // missing as a whole.
    const bool gap = SaturatingDifference(between, left_out) > left_out;
    const int64_t missing = gap ? std::max(announced, SaturatingDifference(between, left_out)) : announced;
    info.gaps += gap ? 1 : 0;
    info.missing = SaturatingSum(info.missing, missing);
    info.announced = SaturatingSum(info.announced, announced);
    previous = tick;
  }
  return info;
}

template <class Message, class Value>
void AddSignal(const std::string& name, const std::string& unit, double scale,
               const std::vector<Message>& messages, Value value, std::vector<SignalInfo>& signals) {
  SignalInfo info{name, unit};
  for (const Message& message : messages) {
    const double number = scale * value(message);
    if (std::isnan(number)) continue;
    info.min = info.count == 0 ? number : std::min(info.min, number);
    info.max = info.count == 0 ? number : std::max(info.max, number);
    info.last = number;
    ++info.count;
  }
  if (!messages.empty()) signals.push_back(std::move(info));
}

// A unit of the paper, converted to the model's system or to SI; "" where nothing tells that system.
SiUnit ShownUnit(const std::optional<UnitSystem>& units, const std::string& paper, int arm, bool si) {
  if (!units) return SiUnit{"", "", 1};
  const std::string own = units->UnitFor(paper, arm);
  const std::optional<SiUnit> shown = si ? FindSiUnit(own, 0) : std::nullopt;
  return shown.value_or(SiUnit{own, own, 1});
}

std::vector<SignalInfo> SignalsOf(const RunMessages& messages, const std::optional<UnitSystem>& units,
                                  bool si) {
  const SiUnit pressure = ShownUnit(units, "psi", 0, si);
  const SiUnit arm_angle = ShownUnit(units, "rad", 1, si), arm_speed = ShownUnit(units, "rad/s", 1, si);
  std::vector<SignalInfo> signals;
  const auto add_state = [&](const std::string& name, const std::string& unit, double scale,
                             double state_t::*member) {
    AddSignal(
        name, unit, scale, messages.Of<state_t>(), [member](const state_t& state) { return state.*member; },
        signals);
  };
  add_state("voltage", "V", 1, &state_t::voltage);
  AddSignal(
      "pressure_ref", pressure.to, pressure.factor, messages.Of<motor_command_t>(),
      [](const motor_command_t& command) { return command.pressure_ref; }, signals);
  AddSignal(
      "arm_ref", arm_angle.to, arm_angle.factor, messages.Of<arm_reference_t>(),
      [](const arm_reference_t& reference) {
        return reference.signal == arm_reference_t::ARM_ANGLE ? reference.value : std::nan("");
      },
      signals);
  add_state("motor_angle", "rad", 1, &state_t::motor_angle);
  add_state("motor_speed", "rad/s", 1, &state_t::motor_speed);
  add_state("arm_angle", arm_angle.to, arm_angle.factor, &state_t::arm_angle);
  add_state("arm_speed", arm_speed.to, arm_speed.factor, &state_t::arm_speed);
  add_state("p1", pressure.to, pressure.factor, &state_t::p1);
  add_state("p2", pressure.to, pressure.factor, &state_t::p2);
  return signals;
}

std::vector<LoopInfo> LoopsOf(const std::vector<loop_statistics_t>& statistics) {
  std::map<std::pair<std::string, std::string>, LoopInfo> loops;
  for (const loop_statistics_t& report : statistics) {
    LoopInfo& loop = loops[{report.role, report.host}];
    loop.last = report;
    if (report.whole_run) {  // the process's own total, up to its end
      loop.cycles = report.cycles;
      loop.missed_deadlines = report.missed_deadlines;
      loop.lost_messages = report.lost_messages;
      continue;
    }
    loop.cycles = SaturatingSum(loop.cycles, report.cycles);
    loop.missed_deadlines = SaturatingSum(loop.missed_deadlines, report.missed_deadlines);
    loop.lost_messages = SaturatingSum(loop.lost_messages, report.lost_messages);
  }
  std::vector<LoopInfo> list;
  list.reserve(loops.size());
  for (auto& [key, loop] : loops) list.push_back(std::move(loop));
  return list;
}

std::vector<ProgramInfo> ProgramsOf(const std::vector<process_status_t>& statuses) {
  std::vector<ProgramInfo> programs;
  std::set<std::tuple<std::string_view, std::string_view, std::string_view>> known;
  for (const process_status_t& status : statuses) {
    if (known.emplace(status.role, status.host, status.version).second)
      programs.push_back({status.role, status.host, status.version});
  }
  return programs;
}

std::vector<run_description_t> DistinctDescriptions(const std::vector<run_description_t>& all) {
  std::vector<run_description_t> distinct;
  std::set<std::tuple<int64_t, std::string_view, std::string_view, std::string_view, std::string_view>> known;
  for (const run_description_t& one : all) {
    if (known.emplace(one.session, one.config_text, one.model_text, one.program, one.version).second)
      distinct.push_back(one);
  }
  return distinct;
}

// The last message of each plant or driver. From a process that has sent no state, it means nothing.
std::vector<output_left_t> OutputsLeft(const RunMessages& messages) {
  std::set<int64_t> plants;
  for (const state_t& state : messages.Of<state_t>()) plants.insert(state.session);
  for (const run_description_t& run : messages.Of<run_description_t>()) plants.insert(run.session);
  std::map<int64_t, output_left_t> last;
  for (const output_left_t& left : messages.Of<output_left_t>()) {
    if (plants.contains(left.session)) last[left.session] = left;
  }
  std::vector<output_left_t> all;
  all.reserve(last.size());
  for (const auto& [session, left] : last) all.push_back(left);
  return all;
}

// Whether two messages report the same stop. A stop is sent again in case the network loses it. A process
// that was asked over its local socket also passes it on, and it knows the tick, which its asker (tick -1)
// does not.
bool IsSameStop(const stop_t& a, const stop_t& b) {
  const bool handed_on = a.source == b.source && (a.tick < 0) != (b.tick < 0);
  return (a.session == b.session || handed_on) && a.reason == b.reason && a.exit_code == b.exit_code;
}

// Each stop once, with its tick if any message has it. A run has a few; more than these are made up, and are
// left out.
std::vector<stop_t> DistinctStops(const std::vector<stop_t>& all) {
  constexpr size_t kMost = 100;
  std::vector<stop_t> distinct;
  for (const stop_t& stop : all) {
    const auto known = std::find_if(distinct.begin(), distinct.end(),
                                    [&](const stop_t& other) { return IsSameStop(stop, other); });
    if (known != distinct.end()) {
      if (known->tick < 0 && stop.tick >= 0) *known = stop;
    } else if (distinct.size() < kMost) {
      distinct.push_back(stop);
    }
  }
  return distinct;
}

// Nothing where the description is damaged; `fault` then says how.
std::optional<UnitSystem> UnitsOf(const run_description_t& description, const std::string& file,
                                  std::string* fault) {
  try {
    return ModelUnits(description, file);
  } catch (const InputError& error) {
    if (fault->empty()) *fault = error.what();
    return std::nullopt;
  }
}

// The details of each of several runs.
std::vector<SenderInfo> SendersOf(const RunLog& log, const std::optional<UnitSystem>& units, bool si,
                                  std::string* fault) {
  std::vector<SenderInfo> senders;
  for (const SenderMessages& run : RunsIn(log.messages)) {
    SenderInfo& sender = senders.emplace_back();
    sender.session = run.session;
    std::optional<UnitSystem> own = units;
    for (const run_description_t& description : run.messages.Of<run_description_t>()) {
      if (description.session != run.session) continue;
      own = UnitsOf(description, log.file, fault);
      sender.description = description.program + ", seed " + std::to_string(description.seed);
    }
    sender.ticks = TicksOf(run.messages);
    sender.signals = SignalsOf(run.messages, own, si);
  }
  return senders;
}

// Returns the units of the run's model. What the log holds shows without a description, too.
std::optional<UnitSystem> ReadDescription(const run_description_t& description, const std::string& file,
                                          LogInfo* info) {
  const std::optional<UnitSystem> units = UnitsOf(description, file, &info->description_fault);
  try {
    if (units) info->model_name = ModelName(description, file);
    info->config = ConfigEntries(description, file);
  } catch (const InputError& error) {
    if (info->description_fault.empty()) info->description_fault = error.what();
  }
  return units;
}

// The duration by the clock that stamped the messages, without its steps. A clock that goes back where two
// recordings join leaves the time between the earliest and the latest message.
double DurationOf(const RunLog& log) {
  const double whole = Seconds(log.first_utime, log.last_utime);
  if (log.clock_steps.empty()) return whole;
  int64_t first_event = std::numeric_limits<int64_t>::max(), last_event = 0, first = 0, last = 0;
  for (const ChannelSummary& channel : log.channels) {
    if (channel.first_event < first_event) first = channel.first_utime;
    if (channel.last_event >= last_event) last = channel.last_utime;
    first_event = std::min(first_event, channel.first_event);
    last_event = std::max(last_event, channel.last_event);
  }
  return Seconds(first, last) - SecondsOfSteps(log.clock_steps, first_event, last_event);
}

}  // namespace

LogInfo Summarise(const RunLog& log, bool si) {
  LogInfo info;
  info.file = log.file;
  info.verdict = log.verdict;
  info.suffix = log.suffix;
  info.joint = log.joint;
  info.other_suffixes = log.other_suffixes;
  info.bytes = log.bytes;
  info.events = log.events;
  info.clock_steps = log.clock_steps;
  info.duration_s = DurationOf(log);
  info.first_undecodable = log.first_undecodable;
  for (const ChannelSummary& channel : log.channels) info.channels.push_back(ChannelOf(channel, log));
  info.loops = LoopsOf(log.messages.Of<loop_statistics_t>());
  info.programs = ProgramsOf(log.messages.Of<process_status_t>());
  info.faults = log.messages.Of<fault_t>();
  info.stops = DistinctStops(log.messages.Of<stop_t>());
  info.tunings = TuningSteps(log.messages);
  info.outputs_left = OutputsLeft(log.messages);
  info.descriptions = DistinctDescriptions(log.messages.Of<run_description_t>());
  std::optional<UnitSystem> units = UnitSystem{};
  if (!info.descriptions.empty()) units = ReadDescription(info.descriptions.front(), log.file, &info);
  info.several_runs = HoldsSeveralRuns(log.messages);
  if (info.several_runs) {
    info.senders = SendersOf(log, units, si, &info.description_fault);
  } else {
    info.ticks = TicksOf(log.messages);
    info.signals = SignalsOf(log.messages, units, si);
  }
  return info;
}

int64_t MissingMessages(const LogInfo& info) {
  int64_t missing = 0;
  for (const ChannelInfo& channel : info.channels) {
    if (channel.numbered) missing = SaturatingSum(missing, channel.missing);
  }
  return missing;
}

}  // namespace hydro::runs
