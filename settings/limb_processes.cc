#include "settings/limb_processes.h"

#include <algorithm>

#include "base/text_file.h"
#include "settings/process_sections.h"
#include "settings/stack_document.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

std::string ErrorOf(const JointDocument& document, const std::string& file, ModelFiles* models) {
  TomlNode root = document.root;
  try {
    StackOf(&root, file, models);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The place in `node`, or in a node inside it, with which the message begins; empty: the message begins with
// some other place.
std::string PlaceIn(const TomlNode& node, const std::string& message) {
  if (message.starts_with(node.place + ": ")) return node.place;
  for (const TomlMember& member : node.members) {
    if (std::string place = PlaceIn(member.second, message); !place.empty()) return place;
  }
  for (const TomlNode& item : node.items) {
    if (std::string place = PlaceIn(item, message); !place.empty()) return place;
  }
  return "";
}

// The values of a joint that come from the sections for all joints.
TomlNode WithoutOwn(TomlNode document, const TomlNode& own) {
  for (const auto& [section, values] : own.members) {
    TomlNode* merged = document.Find(section);
    if (merged == nullptr || !merged->is(TomlNode::Kind::kTable)) continue;
    for (const TomlMember& value : values.members) merged->Erase(value.first);
  }
  return document;
}

bool NamesItsModel(const TomlNode& root) {
  const TomlNode* model = root.Find("model");
  return model != nullptr && model->Find("file") != nullptr;
}

void CheckJoint(const std::string& joint, const ProcessSection& process, const StackConfig& common) {
  if (std::find(common.joints.begin(), common.joints.end(), joint) != common.joints.end()) return;
  throw KeyError(process.place, "process." + std::string(process.joint.empty() ? "joints" : "joint"),
                 Quoted(joint), QuotedList(common.joints));
}

// `in_limbs` holds the joints that a hydro-limb runs.
void CheckEachJointRuns(const StackConfig& common, const std::vector<std::string>& in_limbs) {
  for (const std::string& joint : common.joints) {
    const bool own =
        std::any_of(common.processes.begin(), common.processes.end(), [&](const ProcessSection& process) {
          return process.joint == joint && (process.role == "plant" || process.role == "driver");
        });
    if (own || std::find(in_limbs.begin(), in_limbs.end(), joint) != in_limbs.end()) continue;
    const std::string place = common.processes.empty() ? common.file : common.processes.front().place;
    throw KeyError(
        place, "process", "no process that runs the joint " + Quoted(joint),
        "one: hydro-limb with it in joints, or hydro-plant or hydro-driver with joint = " + Quoted(joint));
  }
}

}  // namespace

std::vector<std::string> ModelsOfJoints(const TomlNode& root) {
  const TomlNode* joints = root.Find("joint");
  std::vector<std::string> models;
  if (joints == nullptr) return models;
  for (const TomlNode& joint : joints->items)
    models.push_back(ModelNameIn(NamesItsModel(joint) ? joint : root));
  return models;
}

void CheckUnitsOfJoints(const std::vector<std::string>& written, const TomlNode& root,
                        const std::vector<JointDocument>& documents, const std::string& file,
                        ModelFiles* models) {
  const UnitSystem common = UnitsOfModelIn(NamesItsModel(root) ? root : documents.front().root, file, models);
  for (size_t i = 0; i < documents.size(); ++i) {
    const TomlNode& document = documents[i].root;
    try {
      if (i < written.size()) CheckUnitsOfOtherModel(written[i], document, file, models);
      if (root.Find("arm") != nullptr) continue;  // all joints of an arm have the same units
      CheckNumbersKeepTheirUnits(WithoutOwn(document, root.Find("joint")->items[i]), document, common,
                                 UnitsOfModelIn(document, file, models));
    } catch (const InputError& error) {
      const std::string message = error.what();
      const size_t place = message.find(": ");
      throw InputError(message.substr(0, place) + ": joint " + documents[i].name + message.substr(place));
    }
  }
}

StackConfig StackOfDocument(const TomlNode& root, const std::vector<JointDocument>& documents, size_t index,
                            const std::string& file, ModelFiles* models) {
  TomlNode own = documents[index].root;
  try {
    return StackOf(&own, file, models);
  } catch (const InputError& error) {
    const std::string message = error.what();
    std::string place = PlaceIn(root.Find("joint")->items[index], message);
    const auto says_the_same = [&](const JointDocument& other) {
      return ErrorOf(other, file, models) == message;
    };
    if (place.empty() && std::all_of(documents.begin(), documents.end(), says_the_same)) throw;
    if (place.empty()) place = message.substr(0, message.find(": "));
    throw InputError(place + ": joint " + documents[index].name + message.substr(place.size()));
  }
}

std::vector<std::string> JointsOf(const ProcessSection& process, const StackConfig& common) {
  if (!process.joint.empty()) return {process.joint};
  std::vector<std::string> joints;
  for (const std::string& joint : common.joints) {
    const auto has = [&](const ProcessSection& other) {
      return other.joint == joint ||
             std::find(other.joints.begin(), other.joints.end(), joint) != other.joints.end();
    };
    const bool mine = !process.joints.empty()
                          ? has(process)
                          : std::none_of(common.processes.begin(), common.processes.end(), has);
    if (mine) joints.push_back(joint);
  }
  return joints;
}

void CheckProcesses(const StackConfig& common) {
  std::vector<std::string> taken;
  for (const ProcessSection& process : common.processes) {
    const bool whole = process.role == "limb" || process.role == "logger";
    if (whole && !process.joint.empty()) {
      throw KeyError(process.place, "process.joint", Quoted(process.joint), "none for " + NameOf(process));
    }
    if (!whole && process.joint.empty()) {
      throw KeyError(
          process.place, "process.program", NameOf(process) + " without a joint",
          "joint = \"NAME\" beside it, or hydro-limb, which has the joints that no other process has");
    }
    if (!process.joint.empty()) CheckJoint(process.joint, process, common);
    if (process.role != "limb") continue;
    std::vector<std::string> named;
    for (const std::string& joint : process.joints) {
      CheckJoint(joint, process, common);
      if (std::find(named.begin(), named.end(), joint) != named.end())
        throw KeyError(process.place, "process.joints", Quoted(joint) + " twice", "each joint once");
      named.push_back(joint);
    }
    const std::vector<std::string> joints = JointsOf(process, common);
    if (joints.empty()) {
      throw KeyError(process.place, "process", "hydro-limb, but other processes have all joints",
                     "it with joints that no other has: name them in joints");
    }
    for (const std::string& joint : joints) {
      if (std::find(taken.begin(), taken.end(), joint) != taken.end()) {
        throw KeyError(process.place, "process.joints", "a second process with the joint " + Quoted(joint),
                       "one process for each joint");
      }
      taken.push_back(joint);
    }
  }
  CheckEachJointRuns(common, taken);
}

void CheckArmIsWhole(const StackConfig& common) {
  for (const ProcessSection& process : common.processes) {
    if (process.role == "logger" || JointsOf(process, common) == common.joints) continue;
    throw KeyError(process.place, process.joint.empty() ? "process.joints" : "process.joint",
                   "some of the joints of an [arm]", "all of them in one hydro-limb");
  }
}

}  // namespace hydro::settings
