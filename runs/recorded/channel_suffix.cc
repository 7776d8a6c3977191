#include "runs/recorded/channel_suffix.h"

#include <algorithm>
#include <hydro/run_description_t.hpp>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/input_error.h"
#include "base/text_file.h"
#include "bus/channels.h"
#include "runs/log/message_kinds.h"
#include "settings/toml/toml_document.h"

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
  constexpr size_t kMostListed = 20;
  std::string list;
  size_t listed = 0;
  for (const std::string& suffix : suffixes) {
    if (listed++ == kMostListed)
      return list + ", ... (" + std::to_string(suffixes.size() - kMostListed) + " more)";
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

using settings::TomlNode;

// A text that cannot be read counts as empty, because others need the rest of the log.
TomlNode Parsed(const std::string& text) {
  try {
    return settings::ParseToml(text, "");
  } catch (const InputError&) {
    return {};
  }
}

std::vector<std::string> JointNamesIn(const std::string& text) {
  std::vector<std::string> names;
  const TomlNode root = Parsed(text);
  const TomlNode* joints = root.Find("joint");
  if (joints == nullptr) return names;
  for (const TomlNode& joint : joints->items) {
    if (const TomlNode* name = joint.Find("name")) names.push_back(name->text);
  }
  return names;
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

void LimbConfigs::TakeFirst(const log::LogEvent& event) {
  const log::MessageKind* kind = log::KindOfChannel(event.channel);
  run_description_t description;
  if (kind == nullptr || kind->hash != run_description_t::getHash()) return;
  if (!log::DecodeAs(event, description)) return;
  texts_[std::string(event.channel.substr(kind->channel.size()))] = std::move(description.config_text);
}

std::string LimbConfigs::Of(const std::string& limb) const {
  const auto found = texts_.find(limb);
  return found == texts_.end() ? "" : found->second;
}

void LimbConfigs::Order(std::vector<JointChannels>* joints) const {
  std::map<std::string, std::unordered_map<std::string, size_t>> places;  // by limb, then by name
  for (const JointChannels& joint : *joints) {
    const auto [limb, is_new] = places.try_emplace(joint.limb);
    if (!is_new) continue;
    for (const std::string& name : JointNamesIn(Of(joint.limb)))
      limb->second.try_emplace(name, limb->second.size());
  }
  const auto place = [&](const JointChannels& joint) {
    const auto& all = places.at(joint.limb);
    const auto found = all.find(joint.name);
    return std::pair(joint.limb, found == all.end() ? all.size() : found->second);
  };
  std::ranges::stable_sort(*joints, {}, place);
}

bool HasArm(const std::string& limb_config) { return Parsed(limb_config).Find("arm") != nullptr; }

}  // namespace hydro::runs
