#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "base/number_text.h"
#include "runs/info.h"

namespace hydro::runs {
namespace {

[[gnu::format(printf, 2, 3)]] void Append(std::string& text, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  va_list again;
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  const size_t before = text.size();
  text.resize(before + static_cast<size_t>(size) + 1);
  std::vsnprintf(text.data() + before, static_cast<size_t>(size) + 1, format, again);
  va_end(again);
  text.pop_back();
}

void AppendDescriptions(const LogInfo& info, std::string& text) {
  for (const run_description_t& description : info.descriptions) {
    Append(text, "run: %s %s on %s, configuration %s, model %s, seed %lld\n", description.program.c_str(),
           description.version.c_str(), description.host.c_str(), description.config_file.c_str(),
           description.model_file.empty() ? "none" : description.model_file.c_str(),
           static_cast<long long>(description.seed));
  }
  if (!info.model_name.empty()) Append(text, "model: %s\n", info.model_name.c_str());
  for (const ProgramInfo& program : info.programs) {
    Append(text, "process: %s %s on %s\n", program.role.c_str(), program.version.c_str(),
           program.host.c_str());
  }
  for (const auto& [key, value] : info.config) Append(text, "config: %s = %s\n", key.c_str(), value.c_str());
}

void AppendChannels(const LogInfo& info, std::string& text) {
  Append(text, "%-32s %10s %12s %8s %8s\n", "channel", "messages", "rate (Hz)", "lost", "repeated");
  for (const ChannelInfo& channel : info.channels) {
    Append(text, "%-32s %10lld %12.2f", channel.summary.channel.c_str(),
           static_cast<long long>(channel.summary.events), channel.rate_hz);
    if (channel.numbered) {
      Append(text, " %8lld %8lld", static_cast<long long>(channel.lost),
             static_cast<long long>(channel.repeated));
      if (channel.senders > 1) Append(text, "  %lld senders", static_cast<long long>(channel.senders));
      if (channel.before_first > 0) {
        Append(text, "  %lld sent before the log began", static_cast<long long>(channel.before_first));
      }
    }
    if (channel.summary.undecodable > 0) {
      Append(text, "  %lld undecodable", static_cast<long long>(channel.summary.undecodable));
    }
    text += '\n';
  }
  if (!info.first_undecodable.empty()) {
    Append(text, "undecodable messages are left out; the first: %s\n", info.first_undecodable.c_str());
  }
}

void AppendTicks(const TickInfo& ticks, std::string& text) {
  if (ticks.states == 0) return;
  Append(text, "ticks: %lld, from %lld at %.6g s to %lld at %.6g s, %.6g a second of plant time\n",
         static_cast<long long>(ticks.states), static_cast<long long>(ticks.first), ticks.first_time_s,
         static_cast<long long>(ticks.last), ticks.last_time_s, ticks.rate_hz);
  Append(text, "tick gaps: %lld, without state: %lld, of which the plant skipped %lld\n",
         static_cast<long long>(ticks.gaps), static_cast<long long>(ticks.missing),
         static_cast<long long>(ticks.announced));
}

void AppendSignals(const LogInfo& info, std::string& text) {
  if (info.signals.empty()) return;
  Append(text, "%-32s %12s %12s %12s\n", "signal", "min", "max", "last");
  for (const SignalInfo& signal : info.signals) {
    const std::string name = signal.name + " (" + signal.unit + ")";
    if (signal.count == 0) {
      Append(text, "%-32s %12s\n", name.c_str(), "none");
    } else {
      Append(text, "%-32s %12.6g %12.6g %12.6g\n", name.c_str(), signal.min, signal.max, signal.last);
    }
  }
}

void AppendLoops(const LogInfo& info, std::string& text) {
  if (info.loops.empty()) return;
  Append(text, "%-32s %10s %21s %31s %8s %8s\n", "loop", "cycles", "period p50/p99 (us)",
         "latency p50/p99/max (us)", "missed", "lost");
  for (const LoopInfo& loop : info.loops) {
    const loop_statistics_t& last = loop.last;
    Append(text, "%-32s %10lld %10.1f/%10.1f %10.1f/%9.1f/%10.1f %8lld %8lld\n",
           (last.role + "@" + last.host).c_str(), static_cast<long long>(loop.cycles), last.period_p50_us,
           last.period_p99_us, last.latency_p50_us, last.latency_p99_us, last.latency_max_us,
           static_cast<long long>(loop.missed_deadlines), static_cast<long long>(loop.lost_messages));
  }
}

void AppendEnds(const LogInfo& info, std::string& text) {
  for (const fault_t& fault : info.faults) {
    Append(text, "fault: tick %lld: %s: %s %s: %s\n", static_cast<long long>(fault.tick),
           fault.source.c_str(), fault.code.c_str(), fault.active != 0 ? "begins" : "has gone",
           fault.text.c_str());
  }
  if (info.faults.empty()) text += "faults: none\n";
  for (const stop_t& stop : info.stops) {
    Append(text, "stop: tick %lld: %s: %s (exit code %d)\n", static_cast<long long>(stop.tick),
           stop.source.c_str(), stop.reason.c_str(), stop.exit_code);
  }
}

}  // namespace

std::string InfoText(const LogInfo& info) {
  std::string text;
  Append(text, "%s: %lld messages, %lld bytes, %.6g s\n", info.file.c_str(),
         static_cast<long long>(info.events), static_cast<long long>(info.bytes), info.duration_s);
  if (!info.suffix.empty()) Append(text, "channel suffix: %s\n", info.suffix.c_str());
  AppendDescriptions(info, text);
  AppendChannels(info, text);
  AppendTicks(info.ticks, text);
  AppendSignals(info, text);
  AppendLoops(info, text);
  AppendEnds(info, text);
  return text;
}

}  // namespace hydro::runs
