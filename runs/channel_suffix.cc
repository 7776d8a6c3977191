#include "runs/channel_suffix.h"

#include <algorithm>

#include "base/input_error.h"
#include "bus/channels.h"
#include "log/message_kinds.h"

namespace hydro::runs {
namespace {

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

int64_t EventsOn(const RunLog& log, const std::string& name) {
  const auto channel = std::ranges::find(log.channels, name, &ChannelSummary::channel);
  return channel == log.channels.end() ? 0 : channel->events;
}

// The stack whose run the log is of, where the rest are strays: a packet on another state channel must not make
// a log unreadable.
std::optional<std::string> OwnSuffix(const RunLog& log, const std::set<std::string>& suffixes) {
  std::set<std::string> described;
  int64_t states = 0;
  for (const std::string& suffix : suffixes) {
    const bus::Channels channels(suffix);
    if (EventsOn(log, channels.Of<run_description_t>()) > 0) described.insert(suffix);
    states += EventsOn(log, channels.Of<state_t>());
  }
  if (described.size() == 1) return *described.begin();
  if (described.size() > 1) return std::nullopt;
  for (const std::string& suffix : suffixes) {
    if (EventsOn(log, bus::Channels(suffix).Of<state_t>()) > states / 10 * 9) return suffix;
  }
  return std::nullopt;
}

}  // namespace

std::set<std::string> StateSuffixes(const RunLog& log) { return SuffixesOf(log, true); }

std::string ChooseSuffix(const RunLog& log, const std::optional<std::string>& wanted) {
  const std::set<std::string> all = SuffixesOf(log, false);
  if (wanted.has_value()) {
    if (all.contains(*wanted)) return *wanted;
    throw InputError(log.file + ": found no channel with suffix '" + *wanted + "'; the log has " +
                     (all.empty() ? "no HYDRO_ channel" : ListOf(all)));
  }
  std::set<std::string> suffixes = StateSuffixes(log);
  if (suffixes.empty()) suffixes = all;
  if (suffixes.size() > 1) {
    if (const std::optional<std::string> own = OwnSuffix(log, suffixes)) return *own;
    throw InputError(log.file + ": found channels with the suffixes " + ListOf(suffixes) +
                     "; choose one of them with --suffix");
  }
  return suffixes.empty() ? "" : *suffixes.begin();
}

}  // namespace hydro::runs
