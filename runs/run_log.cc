#include "runs/run_log.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "base/big_endian.h"
#include "base/number_text.h"
#include "bus/channels.h"
#include "log/log_format.h"
#include "log/log_reader.h"
#include "log/message_kinds.h"
#include "runs/channel_suffix.h"

namespace hydro::runs {
namespace {

std::string Hex(uint64_t value) { return HexNumber(value, 16); }

// Where the event is, what was found and what is allowed.
std::string WhyUndecodable(const log::LogEvent& event, const log::MessageKind& kind) {
  const std::string place = "byte " + std::to_string(event.offset) + ", event " +
                            std::to_string(event.index) + " on " + std::string(event.channel) + ": ";
  const uint64_t hash = event.size >= 8 ? LoadBigEndian64(event.data) : 0;
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

}  // namespace

RunLog ReadRunLog(const std::string& file, const std::optional<std::string>& suffix, Undecodable undecodable,
                  log::OnDamage on_damage) {
  RunLog log;
  log.file = file;
  log::LogReader reader(file, on_damage);
  log.verdict = reader.verdict();
  log.bytes = reader.size();
  Summarise(reader, log);
  log.suffix = ChooseSuffix(log, suffix);
  for (const std::string& other : StateSuffixes(log)) {
    if (other != log.suffix) log.other_suffixes.push_back(other);
  }

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

std::string DescribeCaution(const RunLog& log) {
  std::string text = log::Caution(log.verdict);
  if (!log.other_suffixes.empty()) {
    text += (text.empty() ? "" : "; ") + std::string("read channels with suffix '") + log.suffix +
            "', not those with '" + log.other_suffixes.front() + "'" +
            (log.other_suffixes.size() > 1 ? " and others" : "") + " (--suffix)";
  }
  return text.empty() ? text : log.file + ": " + text;
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
