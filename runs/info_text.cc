#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <iterator>

#include "base/number_text.h"
#include "base/text_file.h"
#include "base/utf8.h"
#include "bus/output_left.h"
#include "runs/info.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/senders.h"

namespace hydro::runs {
namespace {

// Text from a log may hold anything. A line break in it must not forge a line of this program's output, and
// the text must not fill the screen.
std::string Shown(const std::string& text) {
  constexpr size_t kLongest = 500;
  return Printable(text.size() <= kLongest ? text : std::string(FirstBytes(text, kLongest)) + "...");
}
template <class Value>
const Value& Shown(const Value& value) {
  return value;
}

template <class... Arguments>
void Append(std::string& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(text), fmt::runtime(fmt::string_view(format)), Shown(arguments)...);
}

std::string Number(double value) { return ShortNumber(value, 6); }

void AppendVerdict(const log::LogVerdict& verdict, std::string& text) {
  Append(text, "log: {}{}{}\n", NameOf(verdict.completeness), verdict.where.empty() ? "" : ": ",
         verdict.where);
  if (!verdict.note.empty()) Append(text, "log: {}\n", verdict.note);
  for (const std::string& remark : verdict.remarks) Append(text, "log: {}\n", remark);
  if (!verdict.ending.empty()) Append(text, "log: ends here: {}\n", verdict.ending);
  if (verdict.completeness == log::Completeness::kDamaged) {
    text += "what follows is of the messages before the damage; hydro-log repair keeps what can be read\n";
  }
}

void AppendDescriptions(const LogInfo& info, std::string& text) {
  for (const run_description_t& description : info.descriptions) {
    Append(text, "run: {} {} on {}, configuration {}, model {}, seed {}\n", description.program,
           description.version, description.host, description.config_file,
           description.model_file.empty() ? "none" : description.model_file, description.seed);
  }
  if (!info.description_fault.empty()) Append(text, "run: not known: {}\n", info.description_fault);
  if (!info.model_name.empty()) Append(text, "model: {}\n", info.model_name);
  for (const ProgramInfo& program : info.programs) {
    Append(text, "process: {} {} on {}\n", program.role, program.version, program.host);
  }
  for (const auto& [key, value] : info.config) Append(text, "config: {} = {}\n", key, value);
}

void AppendChannels(const LogInfo& info, std::string& text) {
  Append(text, "{:<32} {:>10} {:>12} {:>8} {:>8}\n", "channel", "messages", "rate (Hz)", "missing",
         "repeated");
  for (const ChannelInfo& channel : info.channels) {
    Append(text, "{:<32} {:>10} {:>12.2f}", channel.summary.channel, channel.summary.events, channel.rate_hz);
    if (channel.numbered) {
      Append(text, " {:>8} {:>8}", channel.missing, channel.repeated);
      if (channel.senders > 1) Append(text, "  {} senders", channel.senders);
      if (channel.before_first > 0) Append(text, "  {} sent before the log began", channel.before_first);
    }
    if (channel.summary.undecodable > 0) Append(text, "  {} undecodable", channel.summary.undecodable);
    text += '\n';
  }
  if (!info.first_undecodable.empty()) {
    Append(text, "undecodable messages are left out; the first: {}\n", info.first_undecodable);
  }
}

void AppendTicks(const TickInfo& ticks, std::string& text) {
  if (ticks.states == 0) return;
  Append(text, "states: {}, from tick {} at {} s to tick {} at {} s, {} ticks a second of plant time\n",
         ticks.states, ticks.first, Number(ticks.first_time_s), ticks.last, Number(ticks.last_time_s),
         Number(ticks.rate_hz));
  if (ticks.sampled > 1) Append(text, "sampled: {}, not each\n", DescribeSampling(ticks.sampled));
  Append(text,
         "tick gaps: {}, without state: {}, of which the plant skipped {} and {} are missing from the log\n",
         ticks.gaps, ticks.missing, ticks.announced, ticks.missing - ticks.announced);
}

// Lists where the clock that stamped the messages differs from plant time.
void AppendClockSteps(const LogInfo& info, std::string& text) {
  constexpr size_t kListed = 20;
  for (const ClockStep& step : info.clock_steps) {
    if (static_cast<size_t>(&step - info.clock_steps.data()) == kListed) {
      Append(text, "clock: and {} more\n", info.clock_steps.size() - kListed);
      break;
    }
    const std::string seconds = ShortNumber(std::abs(step.seconds), 3);
    if (step.joined) {
      Append(text, "clock: another run begins, {} s {}; duration and rates leave that out\n", seconds,
             step.seconds > 0 ? "after the one before has ended"
                              : "earlier by its clock than the one before has ended");
      continue;
    }
    Append(text, "clock: {} at {} s of plant time; duration and rates leave it out\n",
           step.seconds > 0 ? seconds + " s without a message" : "set back by " + seconds + " s",
           Number(step.at_time_s));
  }
}

void AppendSignals(const std::vector<SignalInfo>& signals, std::string& text) {
  if (signals.empty()) return;
  Append(text, "{:<32} {:>12} {:>12} {:>12}\n", "signal", "min", "max", "last");
  for (const SignalInfo& signal : signals) {
    const std::string name = signal.name + (signal.unit.empty() ? "" : " (" + signal.unit + ")");
    if (signal.count == 0) {
      Append(text, "{:<32} {:>12}\n", name, "none");
    } else {
      Append(text, "{:<32} {:>12} {:>12} {:>12}\n", name, Number(signal.min), Number(signal.max),
             Number(signal.last));
    }
  }
}

// Gives each run its own table, because one table over several runs would describe none of them.
void AppendRuns(const LogInfo& info, std::string& text) {
  AppendTicks(info.ticks, text);
  AppendClockSteps(info, text);
  AppendSignals(info.signals, text);
  if (!info.several_runs) return;
  if (info.senders.empty())
    text +=
        "runs: states of several that cannot be told apart: their senders have one session, or there are "
        "more "
        "than " +
        std::to_string(kMostRuns) + "\n";
  for (const SenderInfo& sender : info.senders) {
    Append(text, "run {} of {}, by sender {}: {}\n", &sender - info.senders.data() + 1, info.senders.size(),
           HexNumber(static_cast<uint64_t>(sender.session), 16),
           sender.description.empty() ? "does not describe itself" : sender.description);
    AppendTicks(sender.ticks, text);
    AppendSignals(sender.signals, text);
  }
}

void AppendLoops(const LogInfo& info, std::string& text) {
  if (info.loops.empty()) return;
  Append(text, "{:<32} {:>10} {:>21} {:>31} {:>8} {:>8}\n", "loop", "cycles", "period p50/p99 (us)",
         "latency p50/p99/max (us)", "missed", "lost");
  for (const LoopInfo& loop : info.loops) {
    const loop_statistics_t& last = loop.last;
    Append(text, "{:<32} {:>10} {:>10.1f}/{:>10.1f} {:>10.1f}/{:>9.1f}/{:>10.1f} {:>8} {:>8}\n",
           last.role + "@" + last.host, loop.cycles, last.period_p50_us, last.period_p99_us,
           last.latency_p50_us, last.latency_p99_us, last.latency_max_us, loop.missed_deadlines,
           loop.lost_messages);
  }
}

// Empty for a sender that did not know the tick.
std::string TickText(int64_t tick) { return tick >= 0 ? "tick " + std::to_string(tick) + ": " : ""; }

void AppendEnds(const LogInfo& info, std::string& text) {
  AppendListed(
      info.faults,
      [](const fault_t& fault) {
        return fmt::format("fault: {}{}: {} {}: {}", TickText(fault.tick), fault.source, fault.code,
                           fault.active != 0 ? "begins" : "has gone", bus::ReasonText(fault.text));
      },
      &text);
  if (info.faults.empty()) text += "faults: none\n";
  for (const stop_t& stop : info.stops) {
    Append(text, "stop: {}{}: {} (exit code {})\n", TickText(stop.tick), stop.source,
           bus::ReasonText(stop.reason), stop.exit_code);
  }
  for (const TuningStep& tuning : info.tunings) Append(text, "tuned: {}\n", DescribeTuning(tuning));
  for (const output_left_t& left : info.outputs_left) Append(text, "end: {}\n", bus::OutputLeftText(left));
  if (info.outputs_left.empty()) text += "end: no plant or driver says what voltage it left\n";
}

}  // namespace

std::string InfoText(const LogInfo& info) {
  std::string text;
  Append(text, "{}: {} messages, {} bytes, {} s\n", info.file, info.events, info.bytes,
         Number(info.duration_s));
  AppendVerdict(info.verdict, text);
  if (!info.suffix.empty()) Append(text, "channel suffix: {}\n", info.suffix);
  if (!info.joint.empty()) Append(text, "joint of a limb: {}\n", info.joint);
  for (const std::string& other : info.other_suffixes) {
    Append(text, "channels with suffix '{}' are not read (--suffix)\n", other);
  }
  AppendDescriptions(info, text);
  AppendChannels(info, text);
  AppendRuns(info, text);
  AppendLoops(info, text);
  AppendEnds(info, text);
  return text;
}

}  // namespace hydro::runs
