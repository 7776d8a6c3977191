#include "runs/run_log.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "base/number_text.h"
#include "bus/channels.h"
#include "log/log_format.h"
#include "log/log_reader.h"
#include "log/message_kinds.h"

namespace hydro::runs {
namespace {

std::string Hex(uint64_t value) { return HexNumber(value, 16); }

// Where the event is, what was found and what is allowed.
std::string WhyUndecodable(const log::LogEvent& event, const log::MessageKind& kind) {
  const std::string place = "byte " + std::to_string(event.offset) + ", event " +
                            std::to_string(event.index) + " on " + std::string(event.channel) + ": ";
  const uint64_t hash = event.size >= 8 ? log::LoadBigEndian64(event.data) : 0;
  if (event.size >= 8 && hash != static_cast<uint64_t>(kind.hash)) {
    return place + "found type hash " + Hex(hash) + "; allowed " + Hex(static_cast<uint64_t>(kind.hash)) +
           " (" + kind.type + " of this version)";
  }
  return place + "found " + std::to_string(event.size) + " bytes that are not a whole " + kind.type;
}

// Counts events by channel; this pass detects a damaged log before anything is decoded.
void Summarise(log::LogReader& reader, RunLog& log) {
  std::map<std::string_view, ChannelSummary> channels;  // the names lie in the reader's file
  log::LogEvent event;
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
    const log::MessageKind* kind = log::KindOfChannel(channel.channel);
    if (kind == nullptr || (of_state_only && kind != &log::MessageKinds().front())) continue;
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

RunLog ReadRunLog(const std::string& file, const std::optional<std::string>& suffix,
                  Undecodable undecodable) {
  RunLog log;
  log.file = file;
  log::LogReader reader(file);
  log.bytes = reader.size();
  Summarise(reader, log);
  log.suffix = ChooseSuffix(log, suffix);

  const bus::Channels channels(log.suffix);
  log::LogEvent event;
  const auto leave_out = [&](const log::MessageKind& kind) {
    const std::string why = WhyUndecodable(event, kind);
    if (undecodable == Undecodable::kRefused) {
      throw log::LogError(file + ": " + why + "; where others on that channel are, hydro-log repair " + file +
                          " leaves such events out");
    }
    if (log.first_undecodable.empty()) log.first_undecodable = why;
    const auto channel =
        std::lower_bound(log.channels.begin(), log.channels.end(), event.channel,
                         [](const ChannelSummary& a, std::string_view name) { return a.channel < name; });
    ++channel->undecodable;
  };
  // True when the event is a `Message`; it is then in its list or left out.
  const auto take = [&]<class Message>(const bus::MessageRow<Message>&) {
    const std::string& channel = channels.Of<Message>();
    if (event.channel != channel) return false;
    std::vector<Message>& messages = log.messages.Of<Message>();
    if (!log::DecodeAs(event, messages.emplace_back())) {
      messages.pop_back();
      leave_out(*log::KindOfChannel(channel));
    }
    return true;
  };
  reader.Rewind();
  while (reader.Next(event)) bus::AnyMessage(take);
  return log;
}

std::string DescribeUndecodable(const RunLog& log) {
  int64_t all = 0;
  std::string list;
  for (const ChannelSummary& channel : log.channels) {
    if (channel.undecodable == 0) continue;
    all += channel.undecodable;
    list += (list.empty() ? "" : ", ") + std::to_string(channel.undecodable) + " on " + channel.channel;
  }
  if (all == 0) return {};
  return log.file + ": left out " + (all == 1 ? "a message" : std::to_string(all) + " messages") +
         " of another type or version, or torn (" + list + "); the first: " + log.first_undecodable;
}

}  // namespace hydro::runs
