#include "runs/recorded/run_log.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/bytes.h"
#include "base/number_text.h"
#include "bus/channels.h"
#include "runs/log/log_reader.h"
#include "runs/log/message_kinds.h"
#include "runs/recorded/channel_suffix.h"

namespace hydro::runs {
namespace {

std::string Hex(uint64_t value) { return HexNumber(value, 16); }

// Says where the event is, what was found and what is allowed.
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

// Counts events by channel. This pass detects a damaged log before anything is decoded except the limbs'
// descriptions of themselves.
LimbConfigs Summarise(log::LogReader& reader, RunLog& log) {
  LimbConfigs configs;
  std::map<std::string_view, ChannelSummary> channels;  // the names point into the reader's file
  log::LogEvent event;
  while (reader.Next(event)) {
    const auto [place, is_new] = channels.try_emplace(event.channel);
    ChannelSummary& channel = place->second;
    if (is_new) {
      configs.TakeFirst(event);
      channel.channel = std::string(event.channel);
      channel.first_utime = event.utime;
      channel.first_event = event.index;
    }
    ++channel.events;
    channel.bytes += event.size;
    channel.last_utime = event.utime;
    channel.last_event = event.index;
    log.first_utime = log.events == 0 ? event.utime : std::min(log.first_utime, event.utime);
    log.last_utime = log.events == 0 ? event.utime : std::max(log.last_utime, event.utime);
    ++log.events;
  }
  for (auto& [name, channel] : channels) log.channels.push_back(std::move(channel));
  return configs;
}

// Decodes the messages of several stacks.
class Decoder {
 public:
  Decoder(const std::vector<RunLog*>& logs, Undecodable undecodable) : undecodable_(undecodable) {
    stacks_.reserve(logs.size());
    for (RunLog* log : logs) stacks_.push_back({log, bus::Channels(log->suffix)});
    for (Stack& stack : stacks_) {
      for (const std::string& channel : stack.channels.names()) by_channel_.emplace(channel, &stack);
    }
  }

  void Take(const log::LogEvent& event) {
    const auto found = by_channel_.find(event.channel);
    if (found == by_channel_.end()) return;
    Stack& stack = *found->second;
    // Returns true when the event is a `Message`, which is then in its list or was left out.
    bus::AnyMessage([&]<class Message>(const bus::MessageRow<Message>&) {
      if (event.channel != stack.channels.Of<Message>()) return false;
      std::vector<Message>& messages = stack.log->messages.template Of<Message>();
      if (!log::DecodeAs(event, messages.emplace_back())) {
        messages.pop_back();
        LeaveOut(event, stack.log);
      } else if constexpr (std::is_same_v<Message, state_t>) {
        newest_time_ = messages.back().time;
      }
      return true;
    });
  }

  // Plant time of the newest state.
  std::optional<double> newest_time() const { return newest_time_; }

 private:
  struct Stack {
    RunLog* log;
    bus::Channels channels;
  };

  void LeaveOut(const log::LogEvent& event, RunLog* log) const {
    const std::string why = WhyUndecodable(event, *log::KindOfChannel(event.channel));
    if (undecodable_ == Undecodable::kRefused) {
      throw log::LogError(log->file + ": " + why + "; where others on that channel are, hydro-log repair " +
                          log->file + " leaves such events out");
    }
    if (log->first_undecodable.empty()) log->first_undecodable = why;
    const auto channel =
        std::lower_bound(log->channels.begin(), log->channels.end(), event.channel,
                         [](const ChannelSummary& a, std::string_view name) { return a.channel < name; });
    ++channel->undecodable;
  }

  Undecodable undecodable_;
  std::optional<double> newest_time_;
  std::vector<Stack> stacks_;
  std::unordered_map<std::string_view, Stack*> by_channel_;  // the names point into `stacks_`
};

// Finds the suffixes of state channels that are neither read nor belong to a joint of the same limb, and the
// description of this limb.
void FindOthers(const LimbConfigs& configs, RunLog* log) {
  const std::vector<JointChannels> joints = JointsIn(*log);
  const auto self = std::ranges::find(joints, log->suffix, &JointChannels::suffix);
  if (self != joints.end() && joints.size() > 1) log->joint = self->name;
  if (self != joints.end()) log->limb_config = configs.Of(self->limb);
  std::unordered_set<std::string_view> siblings;
  for (const JointChannels& joint : joints) {
    if (self != joints.end() && joint.limb == self->limb) siblings.insert(joint.suffix);
  }
  for (const std::string& other : StateSuffixes(*log)) {
    if (other != log->suffix && !siblings.contains(other)) log->other_suffixes.push_back(other);
  }
}

// A log for each joint, which holds only what concerns that joint's own channels.
std::vector<RunLog> LogsOfJoints(const LimbConfigs& configs, const RunLog& limb) {
  std::vector<RunLog> logs;
  RunLog without_channels = limb;
  without_channels.channels.clear();
  std::unordered_map<std::string, RunLog*> by_suffix;
  std::vector<JointChannels> joints = JointsIn(limb);
  configs.Order(&joints);
  logs.reserve(joints.size());
  for (const JointChannels& joint : joints) {
    RunLog& log = logs.emplace_back(without_channels);
    log.suffix = joint.suffix;
    log.joint = joint.name;
    log.limb_config = configs.Of(joint.limb);
    by_suffix[joint.suffix] = &log;
  }
  for (const ChannelSummary& channel : limb.channels) {
    const log::MessageKind* kind = log::KindOfChannel(channel.channel);
    if (kind == nullptr) continue;
    const auto log = by_suffix.find(channel.channel.substr(kind->channel.size()));
    if (log != by_suffix.end()) log->second->channels.push_back(channel);
  }
  return logs;
}

// `with_joints` says whether all joints of a limb are read when none is chosen.
LimbLog Read(const std::string& file, const StackChoice& choice, Undecodable undecodable,
             log::OnDamage on_damage, bool with_joints) {
  LimbLog all;
  all.limb.file = file;
  log::LogReader reader(file, on_damage);
  all.limb.verdict = reader.verdict();
  all.limb.bytes = reader.size();
  const LimbConfigs configs = Summarise(reader, all.limb);
  std::vector<RunLog*> logs;
  if (with_joints && IsWholeLimb(all.limb, choice)) {
    all.limb.suffix = JointsIn(all.limb).front().limb;
    all.joints = LogsOfJoints(configs, all.limb);
    for (RunLog& joint : all.joints) logs.push_back(&joint);
  } else {
    all.limb.suffix = ChooseSuffix(all.limb, choice);
    FindOthers(configs, &all.limb);
  }
  logs.push_back(&all.limb);
  Decoder decoder(logs, undecodable);
  log::LogEvent event;
  reader.Rewind();
  ClockWatch clock;
  while (reader.Next(event)) {
    decoder.Take(event);
    clock.Take(event.index, event.utime, decoder.newest_time());
  }
  all.limb.clock_steps = clock.steps();
  for (RunLog& joint : all.joints) joint.clock_steps = clock.steps();
  return all;
}

}  // namespace

void AddStackChoice(settings::CommandLine* verb, StackChoice* choice) {
  verb->AddOption("--suffix", &choice->suffix, "TEXT suffix of the channels, where a log has several");
  verb->AddOption("--joint", &choice->joint, "NAME read this joint of a limb, where a log has several");
}

RunLog ReadRunLog(const std::string& file, const StackChoice& choice, Undecodable undecodable,
                  log::OnDamage on_damage) {
  return Read(file, choice, undecodable, on_damage, false).limb;
}

LimbLog ReadLimbLog(const std::string& file, const StackChoice& choice, Undecodable undecodable,
                    log::OnDamage on_damage) {
  return Read(file, choice, undecodable, on_damage, true);
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
