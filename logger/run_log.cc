#include "logger/run_log.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <string_view>

#include "logger/log_format.h"
#include "logger/log_reader.h"
#include "logger/message_kinds.h"

namespace hydro {
namespace {

std::string Hex(uint64_t value) {
  char text[19];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(value));
  return text;
}

[[noreturn]] void ThrowUndecodable(const std::string& file, const LogEvent& event, const MessageKind& kind) {
  const std::string place = file + ": byte " + std::to_string(event.offset) + ", event " +
                            std::to_string(event.index) + " on " + std::string(event.channel) + ": ";
  const uint64_t hash = event.size >= 8 ? LoadBigEndian64(event.data) : 0;
  if (event.size >= 8 && hash != static_cast<uint64_t>(kind.hash)) {
    throw LogError(place + "found type hash " + Hex(hash) + "; allowed " +
                   Hex(static_cast<uint64_t>(kind.hash)) + " (" + kind.type +
                   " of this version); where others on that channel are, hydro-log repair " + file +
                   " leaves such events out");
  }
  throw LogError(place + "found " + std::to_string(event.size) + " bytes that are not a whole " + kind.type +
                 "; hydro-log repair " + file + " leaves such events out");
}

// Counts events by channel; a damaged log is noticed here, before anything is decoded.
void Summarise(LogReader& reader, RunLog& log) {
  std::map<std::string_view, ChannelSummary> channels;  // the names lie in the reader's file
  LogEvent event;
  while (reader.Next(event)) {
    const auto [place, is_new] = channels.try_emplace(event.channel);
    ChannelSummary& channel = place->second;
    if (is_new) {
      channel.channel = std::string(event.channel);
      channel.first_utime = event.utime;
    }
    ++channel.events;
    channel.bytes += event.size;
    channel.last_utime = event.utime;
    log.first_utime = log.events == 0 ? event.utime : std::min(log.first_utime, event.utime);
    log.last_utime = log.events == 0 ? event.utime : std::max(log.last_utime, event.utime);
    ++log.events;
  }
  for (auto& [name, channel] : channels) log.channels.push_back(std::move(channel));
}

std::set<std::string> SuffixesOf(const RunLog& log, bool of_state_only) {
  std::set<std::string> suffixes;
  for (const ChannelSummary& channel : log.channels) {
    const MessageKind* kind = KindOfChannel(channel.channel);
    if (kind == nullptr || (of_state_only && kind != &MessageKinds().front())) continue;
    suffixes.insert(channel.channel.substr(kind->channel.size()));
  }
  return suffixes;
}

std::string ListOf(const std::set<std::string>& suffixes) {
  std::string list;
  for (const std::string& suffix : suffixes) list += (list.empty() ? "'" : ", '") + suffix + "'";
  return list;
}

std::string ChooseSuffix(const RunLog& log, const std::optional<std::string>& wanted) {
  const std::set<std::string> all = SuffixesOf(log, false);
  if (wanted.has_value()) {
    if (all.contains(*wanted)) return *wanted;
    throw InputError(log.file + ": found no channel with suffix '" + *wanted + "'; the log has " +
                     (all.empty() ? "no HYDRO_ channel" : ListOf(all)));
  }
  std::set<std::string> suffixes = SuffixesOf(log, true);
  if (suffixes.empty()) suffixes = all;
  if (suffixes.size() > 1) {
    throw InputError(log.file + ": found channels with the suffixes " + ListOf(suffixes) +
                     "; choose one of them with --suffix");
  }
  return suffixes.empty() ? "" : *suffixes.begin();
}

}  // namespace

RunLog ReadRunLog(const std::string& file, const std::optional<std::string>& suffix) {
  RunLog log;
  log.file = file;
  LogReader reader(file);
  log.bytes = reader.size();
  Summarise(reader, log);
  log.suffix = ChooseSuffix(log, suffix);

  const Channels channels(log.suffix);
  LogEvent event;
  // True when the event is on `channel`, and then it is in `messages`.
  const auto keep = [&]<class Message>(const std::string& channel, std::vector<Message>& messages) {
    if (event.channel != channel) return false;
    if (!DecodeAs(event, messages.emplace_back())) ThrowUndecodable(file, event, *KindOfChannel(channel));
    return true;
  };
  reader.Rewind();
  while (reader.Next(event)) {
    keep(channels.state, log.messages.states) || keep(channels.motor_command, log.messages.motor_commands) ||
        keep(channels.pressure_command, log.messages.pressure_commands) ||
        keep(channels.arm_reference, log.messages.arm_references) ||
        keep(channels.fault, log.messages.faults) || keep(channels.run, log.descriptions) ||
        keep(channels.loop_statistics, log.statistics) || keep(channels.loop_histogram, log.histograms) ||
        keep(channels.stop, log.stops) || keep(channels.process_status, log.statuses) ||
        keep(channels.log_progress, log.progress);
  }
  return log;
}

}  // namespace hydro
