#include "settings/joint_documents.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <unordered_set>

#include "base/text_file.h"
#include "base/word_list.h"
#include "settings/overrides.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

constexpr char kChoice[] = "joint=";
// The sections that a joint may have of its own. The others (bus, time, plant, logger) belong to the process,
// and all its joints share them.
constexpr std::array kOwnSections{"model", "pressure", "position", "reference", "limits", "noise", "driver"};
constexpr std::array kOfTheWhole{"joint", "limb", "arm"};
// The sections that the limb has once, for all its joints.
constexpr std::array kShared{"bus", "time", "plant", "logger", "scope", "limb", "arm", "process"};

// LCM's channel names have at most 63 bytes, and this project's longest is HYDRO_TUNING_REQUEST.
constexpr size_t kLongestName = 24;

bool IsJointName(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-'); });
}

std::string NameOf(const TomlNode& joint) {
  constexpr char kJointNames[] = "a name of up to 24 letters, digits, underscores and hyphens";
  if (!joint.is(TomlNode::Kind::kTable))
    throw KeyError(joint.place, "joint", joint.Shown(), "sections [[joint]]");
  const TomlNode* name = joint.Find("name");
  if (name == nullptr) throw KeyError(joint.place, "joint.name", "nothing", kJointNames);
  if (!name->is(TomlNode::Kind::kString) || !IsJointName(name->text)) {
    throw KeyError(name->place, "joint.name", name->Shown(), kJointNames);
  }
  return name->text;
}

InputError NotOfAJoint(const TomlNode& node, const std::string& joint, const std::string& key) {
  const std::string dotted = "joint." + joint + "." + key;
  if (std::find(kShared.begin(), kShared.end(), key) != kShared.end()) {
    return KeyError(node.place, dotted, "what all joints of the limb share",
                    "it outside [[joint]], as " + (key == "process" ? "[[process]]" : "[" + key + "]"));
  }
  std::vector<std::string> known{"name"};
  known.insert(known.end(), kOwnSections.begin(), kOwnSections.end());
  return KeyError(node.place, dotted, "a key that no joint has of its own",
                  "name and the sections " + QuotedList(kOwnSections) + DidYouMean(key, known));
}

void CheckSections(const TomlNode& joint, const std::string& name) {
  for (const auto& [key, node] : joint.members) {
    if (key == "name") continue;
    if (std::find(kOwnSections.begin(), kOwnSections.end(), key) == kOwnSections.end()) {
      throw NotOfAJoint(node, name, key);
    }
    if (!node.is(TomlNode::Kind::kTable)) {
      throw KeyError(node.place, "joint." + name + "." + key, node.Shown(), "a section [joint." + key + "]");
    }
  }
}

bool Concerns(const std::string& override, const std::string& section) {
  return override.starts_with(section + ".") || override.starts_with(section + "=");
}

// The overrides that apply to every joint's own document.
std::vector<std::string> OfAStack(const std::vector<std::string>& overrides) {
  std::vector<std::string> kept;
  for (const std::string& one : overrides) {
    const bool of_the_whole = std::any_of(kOfTheWhole.begin(), kOfTheWhole.end(),
                                          [&](const char* section) { return Concerns(one, section); });
    if (!of_the_whole) kept.push_back(one);
  }
  return kept;
}

TomlNode* SectionOf(TomlNode* root, const std::string& key) {
  if (root->Find(key) == nullptr) {
    TomlNode section;
    section.place = root->place;
    root->members.push_back({key, std::move(section)});
  }
  return root->Find(key);
}

void Put(TomlNode* section, const std::string& key, TomlNode value) {
  value.place = section->place;
  section->Erase(key);
  section->members.push_back({key, std::move(value)});
}

// Keeps the processes of a stack with this joint alone: those that name the joint.
void KeepProcessesOf(const std::string& name, TomlNode* root) {
  TomlNode* processes = root->Find("process");
  if (processes == nullptr || !processes->is(TomlNode::Kind::kArray)) return;
  std::vector<TomlNode> kept;
  for (TomlNode& process : processes->items) {
    const TomlNode* joint = process.is(TomlNode::Kind::kTable) ? process.Find("joint") : nullptr;
    if (joint == nullptr || joint->text != name) continue;
    process.Erase("joint");
    kept.push_back(std::move(process));
  }
  processes->items = std::move(kept);
  if (processes->items.empty()) root->Erase("process");
}

void CountSeedUp(size_t index, TomlNode* root) {
  TomlNode* noise = SectionOf(root, "noise");
  if (!noise->is(TomlNode::Kind::kTable)) return;  // the section's reader reports this
  const TomlNode* given = noise->Find("seed");
  TomlNode seed;
  seed.kind = TomlNode::Kind::kInteger;
  const auto step = static_cast<int64_t>(index);
  const std::optional<int64_t> first = given != nullptr ? WholeNumber(*given) : 1;
  if (!first || *first < 0 || *first > std::numeric_limits<int64_t>::max() - step) return;
  seed.integer = *first + step;
  Put(noise, "seed", seed);
}

}  // namespace

bool HasJoints(const TomlNode& root) { return root.Find("joint") != nullptr; }

std::vector<std::string> JointNames(const TomlNode& root) {
  const TomlNode* joints = root.Find("joint");
  if (joints->is(TomlNode::Kind::kTable)) throw NotAList(joints->place, "joint");
  if (!joints->is(TomlNode::Kind::kArray) || joints->items.empty()) {
    throw KeyError(joints->place, "joint", joints->is(TomlNode::Kind::kArray) ? "none" : joints->Shown(),
                   "sections [[joint]], each with a name");
  }
  if (joints->items.size() > kMostJoints) {
    throw KeyError(joints->items[kMostJoints].place, "joint",
                   std::to_string(joints->items.size()) + " joints", "up to " + std::to_string(kMostJoints));
  }
  std::vector<std::string> names;
  std::unordered_set<std::string> known;
  for (const TomlNode& joint : joints->items) {
    names.push_back(NameOf(joint));
    if (!known.insert(names.back()).second) {
      throw KeyError(joint.place, "joint.name", "a second joint " + Quoted(names.back()), "one of each name");
    }
  }
  return names;
}

std::string JointSuffix(const std::string& common_suffix, const std::string& joint) {
  return common_suffix + "_" + joint;
}

std::optional<std::string> TakeJointChoice(std::vector<std::string>* overrides) {
  std::optional<std::string> choice;
  std::erase_if(*overrides, [&](const std::string& one) {
    if (!one.starts_with(kChoice)) return false;
    choice = one.substr(sizeof(kChoice) - 1);
    return true;
  });
  return choice;
}

std::vector<JointDocument> SplitJoints(const TomlNode& root, const std::vector<std::string>& overrides) {
  const std::vector<std::string> names = JointNames(root);
  const std::vector<std::string> of_all = OfAStack(overrides);
  const bool seed_given =
      std::any_of(of_all.begin(), of_all.end(), [](const auto& one) { return Concerns(one, "noise.seed"); });
  TomlNode common = root;
  for (const char* key : kOfTheWhole) common.Erase(key);
  const TomlNode* bus = root.Find("bus");
  const TomlNode* suffix = bus != nullptr ? bus->Find("channel_suffix") : nullptr;
  std::vector<JointDocument> documents;
  for (size_t i = 0; i < names.size(); ++i) {
    TomlNode own = root.Find("joint")->items[i];
    CheckSections(own, names[i]);
    own.Erase("name");
    const bool own_seed = own.Find("noise") != nullptr && own.Find("noise")->Find("seed") != nullptr;
    JointDocument& document = documents.emplace_back(JointDocument{names[i], common});
    Overlay(own, &document.root);
    ApplyOverrides(of_all, &document.root);
    KeepProcessesOf(names[i], &document.root);
    if (seed_given || !own_seed) CountSeedUp(i, &document.root);
    if (suffix == nullptr || suffix->is(TomlNode::Kind::kString)) {
      Put(SectionOf(&document.root, "bus"), "channel_suffix",
          StringNode(JointSuffix(suffix != nullptr ? suffix->text : "", names[i])));
    }
  }
  return documents;
}

}  // namespace hydro::settings
