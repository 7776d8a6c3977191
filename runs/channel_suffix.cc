#include "runs/channel_suffix.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "base/input_error.h"
#include "base/text_file.h"
#include "bus/channels.h"
#include "runs/log/message_kinds.h"

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

// Anybody on the network can forge channels, so of very many only the first are listed.
std::string ListOf(const std::set<std::string>& suffixes) {
  constexpr size_t kListed = 20;
  std::string list;
  size_t listed = 0;
  for (const std::string& suffix : suffixes) {
    if (listed++ == kListed) return list + ", ... (" + std::to_string(suffixes.size() - kListed) + " more)";
    list += (list.empty() ? "'" : ", '") + suffix + "'";
  }
  return list;
}

// The stack whose run the log holds when the other channels are strays: a packet on another state channel
// must not make a log unreadable.
std::optional<std::string> OwnSuffix(const RunLog& log, const std::set<std::string>& suffixes) {
  std::unordered_map<std::string_view, int64_t> events;
  for (const ChannelSummary& channel : log.channels) events[channel.channel] = channel.events;
  const auto on = [&]<class Message>(const std::string& suffix, const bus::MessageRow<Message>& row) {
    const auto found = events.find(std::string(row.channel) + suffix);
    return found == events.end() ? 0 : found->second;
  };
  std::set<std::string> described;
  int64_t states = 0;
  for (const std::string& suffix : suffixes) {
    if (on(suffix, bus::RowOf<run_description_t>()) > 0) described.insert(suffix);
    states += on(suffix, bus::RowOf<state_t>());
  }
  if (described.size() == 1) return *described.begin();
  if (described.size() > 1) return std::nullopt;
  for (const std::string& suffix : suffixes) {
    if (on(suffix, bus::RowOf<state_t>()) > states / 10 * 9) return suffix;
  }
  return std::nullopt;
}

std::string NamesOf(const std::vector<JointChannels>& joints) {
  std::vector<std::string> names;
  names.reserve(joints.size());
  for (const JointChannels& joint : joints) names.push_back(joint.name);
  return QuotedList(names);
}

// The suffix of the own channels of the limb that has this joint: the longest match among those in the log.
std::optional<std::string> LimbOf(const std::string& suffix, const std::set<std::string>& limbs) {
  if (suffix.size() < 2) return std::nullopt;
  for (size_t end = suffix.rfind('_', suffix.size() - 2); end != std::string::npos;
       end = suffix.rfind('_', end - 1)) {
    if (std::string limb = suffix.substr(0, end); limbs.contains(limb)) return limb;
    if (end == 0) break;
  }
  return std::nullopt;
}

// The suffix of the joint that `choice` names. One name may be the end of another, so the limb's own channels
// count too.
std::string SuffixOfJoint(const RunLog& log, const StackChoice& choice) {
  std::string end = "_" + *choice.joint;
  const std::set<std::string> all = SuffixesOf(log, false);
  std::set<std::string> found, of_a_limb;
  for (const std::string& suffix : all) {
    if (!suffix.ends_with(end)) continue;
    const std::string limb = suffix.substr(0, suffix.size() - end.size());
    if (choice.suffix && limb != *choice.suffix) continue;
    found.insert(suffix);
    if (all.contains(limb)) of_a_limb.insert(suffix);
  }
  if (found.size() > 1 && of_a_limb.size() == 1) return *of_a_limb.begin();
  if (found.size() == 1) return *found.begin();
  if (found.contains(end)) return end;
  if (found.size() > 1) {
    throw InputError(log.file + ": --joint: found " + Quoted(*choice.joint) + " with the suffixes " +
                     ListOf(found) + "; choose one of them with --suffix");
  }
  const std::vector<JointChannels> joints = JointsIn(log);
  throw InputError(log.file + ": --joint: found " + Quoted(*choice.joint) + ", allowed " +
                   (joints.empty()
                        ? "for a log of a limb; this one has " +
                              (all.empty() ? "no HYDRO_ channel" : "channels with suffix " + ListOf(all))
                        : NamesOf(joints)));
}

}  // namespace

std::set<std::string> StateSuffixes(const RunLog& log) { return SuffixesOf(log, true); }

std::vector<JointChannels> JointsIn(const RunLog& log) {
  const std::set<std::string> with_states = StateSuffixes(log);
  std::set<std::string> limbs = SuffixesOf(log, false);
  for (const std::string& suffix : with_states) limbs.erase(suffix);
  if (!with_states.contains("")) limbs.insert("");  // a simulated limb has no channels besides its joints'
  std::vector<JointChannels> joints;
  for (const std::string& suffix : with_states) {
    if (const auto limb = LimbOf(suffix, limbs)) {
      joints.push_back({suffix.substr(limb->size() + 1), suffix, *limb});
    }
  }
  return joints;
}

bool IsWholeLimb(const RunLog& log, const StackChoice& choice) {
  if (choice.given()) return false;
  const std::set<std::string> suffixes = StateSuffixes(log);
  return suffixes.size() > 1 && suffixes.size() <= kMostJoints && !OwnSuffix(log, suffixes) &&
         JointsIn(log).size() == suffixes.size();
}

std::string ChooseSuffix(const RunLog& log, const StackChoice& choice) {
  if (choice.joint) return SuffixOfJoint(log, choice);
  const std::set<std::string> all = SuffixesOf(log, false);
  if (choice.suffix) {
    if (all.contains(*choice.suffix)) return *choice.suffix;
    throw InputError(log.file + ": found no channel with suffix '" + *choice.suffix + "'; the log has " +
                     (all.empty() ? "no HYDRO_ channel" : ListOf(all)));
  }
  std::set<std::string> suffixes = StateSuffixes(log);
  if (suffixes.empty()) suffixes = all;
  if (suffixes.size() > 1) {
    if (const std::optional<std::string> own = OwnSuffix(log, suffixes)) return *own;
    if (IsWholeLimb(log, choice)) {
      throw InputError(log.file + ": found channels of the joints " + NamesOf(JointsIn(log)) +
                       "; choose one of them with --joint");
    }
    throw InputError(log.file + ": found channels with the suffixes " + ListOf(suffixes) +
                     "; choose one of them with --suffix");
  }
  return suffixes.empty() ? "" : *suffixes.begin();
}

}  // namespace hydro::runs
