#include "settings/overrides.h"

#include <algorithm>
#include <unordered_map>

#include "base/text_file.h"
#include "settings/quantity_keys.h"
#include "settings/trajectory_spec.h"

namespace hydro::settings {
namespace {

using NodeKind = TomlNode::Kind;

void SetOrigin(TomlNode* node, const std::string& place) {
  node->place = place;
  node->from_option = true;
  for (auto& member : node->members) SetOrigin(&member.second, place);
  for (TomlNode& item : node->items) SetOrigin(&item, place);
}

void MarkAsOption(TomlNode* node, bool option) {
  node->from_option = option;
  for (auto& member : node->members) MarkAsOption(&member.second, option);
  for (TomlNode& item : node->items) MarkAsOption(&item, option);
}

void LayOver(const TomlNode& own, TomlNode* under) {
  // Places rather than pointers, as the list grows below.
  std::unordered_map<std::string, size_t> places;
  for (size_t i = 0; i < under->members.size(); ++i) places.emplace(under->members[i].first, i);
  for (const auto& [key, node] : own.members) {
    const auto place = places.find(key);
    TomlNode* below = place == places.end() ? nullptr : &under->members[place->second].second;
    if (below != nullptr && below->is(NodeKind::kTable) && node.is(NodeKind::kTable)) {
      LayOver(node, below);
    } else if (below != nullptr) {
      *below = node;
    } else {
      under->members.push_back({key, node});
    }
  }
}

std::string WithoutSpaces(const std::string& text) {
  const size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

TomlNode ParseValue(const std::string& value) {
  try {
    TomlNode table = ParseToml("value = " + value, "");
    if (table.members.size() == 1) return std::move(table.members[0].second);
  } catch (const InputError&) {
    // The value is not TOML: a bare word such as lockstep or udpm://...
  }
  return StringNode(WithoutSpaces(value));
}

// The [[joint]] section of that name.
TomlNode* FindJoint(TomlNode* joints, const std::string& name, const std::string& place) {
  std::vector<std::string> names;
  for (TomlNode& joint : joints->items) {
    const TomlNode* own = joint.is(NodeKind::kTable) ? joint.Find("name") : nullptr;
    if (own == nullptr || !own->is(NodeKind::kString)) continue;
    if (own->text == name) return &joint;
    names.push_back(own->text);
  }
  throw InputError(place + ": joint: found " + Quoted(name) + ", allowed " +
                   (names.empty() ? "no joint: the configuration has none with a name" : QuotedList(names)));
}

// The same path with the key's present name, also after "joint.NAME.".
std::string PresentPath(const std::string& path) {
  size_t begin = 0;
  if (path.starts_with("joint.")) begin = std::min(path.find('.', 6), path.size() - 1) + 1;
  return path.substr(0, begin) + PresentName(path.substr(begin));
}

void ApplyOne(const std::string& option, TomlNode* root) {
  const std::string place = "--set " + Quoted(option).substr(1, Quoted(option).size() - 2);
  const size_t equals = option.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError(place + ": found " + Quoted(option) + ", allowed section.key=value");
  }
  const std::string given = WithoutSpaces(option.substr(0, equals));
  const std::string path = PresentPath(given);
  TomlNode* node = root;
  for (size_t begin = 0; begin <= path.size();) {
    const size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (key.empty()) throw InputError(place + ": found " + Quoted(path) + ", allowed section.key=value");
    if (node->is(NodeKind::kArray) && path.substr(0, begin) == "joint." && end < path.size()) {
      node = FindJoint(node, key, place);
      begin = end + 1;
      continue;
    }
    if (!node->is(NodeKind::kTable)) {
      throw InputError(place + ": " + path.substr(0, begin - 1) + ": found " + node->Shown() + " at " +
                       node->place + ", allowed a section");
    }
    if (node->Find(key) == nullptr) {
      TomlNode section;
      section.place = place;
      section.from_option = true;
      node->members.push_back({key, std::move(section)});
    }
    node = node->Find(key);
    begin = end + 1;
  }
  *node = ParseValue(option.substr(equals + 1));
  SetOrigin(node, place);
  if (path != given) node->former = given.substr(given.rfind('.') + 1);
}

bool FromOption(const TomlNode& section, const std::string& key) {
  const TomlNode* node = section.Find(key);
  return node != nullptr && node->from_option;
}

bool AnyFromOption(const TomlNode& section, const std::vector<std::string>& keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return FromOption(section, key); });
}

// An option that chose one of two alternatives drops the file's keys for the other.
void DropAlternative(const std::vector<std::string>& chosen, const std::vector<std::string>& other,
                     TomlNode* section) {
  if (!AnyFromOption(*section, chosen) || AnyFromOption(*section, other)) return;
  for (const std::string& key : other) section->Erase(key);
}

void DropOtherKinds(TomlNode* section) {
  const TomlNode* kind = section->Find("kind");
  if (kind == nullptr || !kind->from_option || !kind->is(NodeKind::kString)) return;
  const std::vector<std::string> own = KeysOfTrajectory(kind->text);
  if (own.empty()) return;
  for (const char* other : {"steps", "sine", "square", "chirp", "csv", "planner"}) {
    for (const std::string& key : KeysOfTrajectory(other)) {
      const bool fits = std::find(own.begin(), own.end(), key) != own.end();
      if (!fits && !FromOption(*section, key)) section->Erase(key);
    }
  }
}

void DropAlternatives(TomlNode* root) {
  const auto section = [](TomlNode* in, const char* key) {
    TomlNode* node = in == nullptr ? nullptr : in->Find(key);
    return node != nullptr && node->is(NodeKind::kTable) ? node : nullptr;
  };
  if (TomlNode* pressure = section(root, "pressure")) {
    const std::vector<std::string> gains = {"k_p", "k_v"};
    const std::vector<std::string> dynamics = {"natural_frequency_rad_s", "damping_ratio"};
    DropAlternative(gains, dynamics, pressure);
    DropAlternative(dynamics, gains, pressure);
  }
  TomlNode* model = section(root, "model");
  if (model != nullptr && FromOption(*model, "shaft")) {
    const TomlNode* shaft = model->Find("shaft");
    const char* unfit = shaft->is(NodeKind::kString) && shaft->text == "driven" ? "arm_angle" : "motion";
    const TomlNode* node = model->Find(unfit);
    const bool motion_by_option =
        node != nullptr && std::any_of(node->members.begin(), node->members.end(),
                                       [](const auto& member) { return member.second.from_option; });
    if (!FromOption(*model, unfit) && !motion_by_option) model->Erase(unfit);
  }
  for (TomlNode* trajectory : {section(root, "reference"), section(model, "motion")}) {
    if (trajectory == nullptr) continue;
    DropOtherKinds(trajectory);
    DropAlternative({"points"}, {"file", "column"}, trajectory);
    DropAlternative({"file", "column"}, {"points"}, trajectory);
  }
}

}  // namespace

void Overlay(const TomlNode& own, TomlNode* root) {
  TomlNode chosen = own;
  MarkAsOption(root, false);
  MarkAsOption(&chosen, true);
  LayOver(chosen, root);
  DropAlternatives(root);
  MarkAsOption(root, false);
}

void ApplyOverrides(const std::vector<std::string>& overrides, TomlNode* root) {
  for (const std::string& option : overrides) ApplyOne(option, root);
  DropAlternatives(root);
}

}  // namespace hydro::settings
