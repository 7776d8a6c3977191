#include "runs/limb_configs.h"

#include <algorithm>
#include <hydro/run_description_t.hpp>
#include <unordered_map>
#include <utility>

#include "runs/log/message_kinds.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {
namespace {

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
