#include "settings/limb_config.h"

#include <algorithm>

#include "base/number_text.h"
#include "base/text_file.h"
#include "model/terms/model_error.h"
#include "settings/joint_documents.h"
#include "settings/limb_processes.h"
#include "settings/overrides.h"
#include "settings/process_sections.h"
#include "settings/read_quantities.h"
#include "settings/stack_checks.h"
#include "settings/stack_document.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

void ReadLimb(SectionReader section, double rate_hz, LimbSection* limb) {
  section.Choice<OnJointFault>(
      "on_joint_fault",
      {{"all_to_zero", OnJointFault::kAllToZero}, {"others_go_on", OnJointFault::kOthersGoOn}},
      &limb->on_joint_fault);
  if (const TomlNode* rate = section.Take("telemetry_hz")) {
    if (rate->is(TomlNode::Kind::kString) && rate->text == "every_tick") {
      limb->telemetry_hz = rate_hz;
    } else if (rate->is_number() && kPositive.Holds(rate->AsDouble())) {
      limb->telemetry_hz = rate->AsDouble();
    } else {
      throw section.Error("telemetry_hz", rate->Shown(), kPositive.Allowed() + " or \"every_tick\"");
    }
  } else {
    limb->telemetry_hz = std::min(limb->telemetry_hz, rate_hz);
  }
  section.Finish();
  limb->telemetry_interval_ticks = WholeMultiple(rate_hz, limb->telemetry_hz);
  if (limb->telemetry_interval_ticks == 0) {
    throw section.Error(
        "telemetry_hz", ShortestNumber(limb->telemetry_hz),
        "plant.rate_hz = " + ShortestNumber(rate_hz) + " divided by a whole number, or \"every_tick\"");
  }
}

model::ArmLink ReadLink(SectionReader section) {
  model::ArmLink link;
  section.Number("mass", &link.mass, kPositive);
  section.Number("length", &link.length, kPositive);
  section.Number("centre", &link.centre);
  section.Number("inertia", &link.inertia, kNotNegative);
  section.Number("angle_rad", &link.angle);
  for (const char* key : {"mass", "length", "centre", "inertia"}) section.Require(key, "a number");
  section.Finish();
  return link;
}

std::string NamesOf(const UnitSystem& units) {
  return std::string(units.length) + " and " + std::string(units.force);
}

// Each link has one joint that turns it.
std::optional<model::ArmDescription> ArmOf(TomlNode root, const std::vector<JointConfig>& joints) {
  if (root.Find("arm") == nullptr) return std::nullopt;
  ReadQuantities(&root, joints.front().config.model.description.units, FormerNames::kAsMeant);
  SectionReader document(root, "");
  SectionReader section = document.Section("arm");
  model::ArmDescription arm;
  section.Number("gravity", &arm.gravity);
  section.Number("payload", &arm.payload, kNotNegative);
  const TomlNode* links = section.Take("link");
  section.Finish();
  if (links != nullptr && links->is(TomlNode::Kind::kTable)) throw NotAList(links->place, "arm.link");
  const size_t count = links != nullptr && links->is(TomlNode::Kind::kArray) ? links->items.size() : 0;
  if (count != joints.size()) {
    throw KeyError(
        root, "arm.link", std::to_string(count) + " links",
        std::to_string(joints.size()) + ", a section [[arm.link]] for each joint, from the base outwards");
  }
  for (const TomlNode& link : links->items) {
    if (!link.is(TomlNode::Kind::kTable))
      throw KeyError(link.place, "arm.link", link.Shown(), "sections [[arm.link]]");
    arm.links.push_back(ReadLink(section.Item(link, "arm.link")));
  }
  const UnitSystem& units = joints.front().config.model.description.units;
  for (const JointConfig& joint : joints) {
    const ModelSection& model = joint.config.model;
    if (model.shaft == model::Shaft::kDriven) {
      throw KeyError(root, "arm", "it with the joint " + joint.name + ", whose shaft is driven",
                     "shafts that are free, or clamped");
    }
    if (model.description.units.linear_arm) {
      throw KeyError(
          root, "arm",
          "it with the joint " + joint.name + ", whose arm moves along a line (" + model.file + ")",
          "joints that turn, with models whose arm is in rad");
    }
    if (model.description.units != units) {
      throw KeyError(root, "arm",
                     "joints in different units: " + joints.front().name + " in " + NamesOf(units) + ", " +
                         joint.name + " in " + NamesOf(model.description.units),
                     "models in one system of units, in which the links are given too");
    }
  }
  try {
    arm.Check();
  } catch (const model::ModelError& error) {
    throw InputError(root.Find("arm")->place + ": " + error.what());
  }
  return arm;
}

std::string SuffixOf(const JointDocument& document) {
  return document.root.Find("bus")->Find("channel_suffix")->text;
}

// Without [[process]] sections, one process runs all joints.
void PutProcesses(const TomlNode& root, TomlNode* common) {
  common->Erase("process");
  TomlNode processes = ArrayNode({});
  if (const TomlNode* given = root.Find("process")) {
    processes = *given;
  } else {
    TomlNode limb;
    limb.place = root.place;
    limb.members.push_back({"program", StringNode("hydro-limb")});
    processes.items.push_back(std::move(limb));
  }
  common->members.push_back({"process", std::move(processes)});
}

// What the parts of a limb must agree on: the agreed entries of every joint.
std::string AgreedByAll(const std::vector<JointConfig>& joints) {
  std::string text;
  for (const JointConfig& joint : joints) text += "joint " + joint.name + "\n" + joint.config.agreed;
  return text;
}

// Writes the whole limb as one document, with each joint's effective sections inside its own.
TomlNode WholeDocument(const TomlNode& root, const LimbConfig& limb) {
  TomlNode whole = root;
  TomlNode* joints = whole.Find("joint");
  for (size_t i = 0; i < limb.joints.size(); ++i) {
    const TomlNode document = ParseToml(limb.joints[i].config.text, limb.joints[i].name);
    TomlNode& joint = joints->items[i];
    for (const char* key : {"model", "pressure", "position", "reference", "limits", "noise", "driver"}) {
      const TomlNode* section = document.Find(key);
      joint.Erase(key);
      if (section != nullptr) joint.members.push_back({key, *section});
    }
  }
  for (const char* key : {"model", "pressure", "position", "reference", "limits", "noise", "driver"})
    whole.Erase(key);
  return whole;
}

}  // namespace

LimbSection ReadLimbSection(const TomlNode& root, double rate_hz, std::vector<AskedKey>* asked) {
  LimbSection limb;
  SectionReader document(root, "", asked);
  ReadLimb(document.Section("limb"), rate_hz, &limb);
  return limb;
}

double AllowedSilence(const StackConfig& own, const LimbSection& limb) {
  if (own.time.mode == TimeMode::kLockstep) return 0;
  const double period_s =
      static_cast<double>(limb.telemetry_interval_ticks) / (own.plant.rate_hz * own.time.speed);
  return own.limits.stale_input_s + 3 * period_s;
}

StackConfig StackOfJoint(TomlNode root, const std::vector<std::string>& overrides,
                         const std::optional<std::string>& joint) {
  if (!HasJoints(root)) {
    throw InputError("--joint: found " + Quoted(*joint) + ", allowed with [[joint]] sections only, which " +
                     root.place + " does not have");
  }
  const std::vector<std::string> written = ModelsOfJoints(root);
  ApplyOverrides(overrides, &root);
  const std::vector<std::string> names = JointNames(root);
  if (!joint) {
    throw KeyError(root.Find("joint")->items.front().place, "joint", "joints (" + QuotedList(names) + ")",
                   "a stack with one: choose it with --joint NAME; hydro-limb and hydro-sim run them all");
  }
  std::optional<StackConfig> chosen;
  std::vector<Sibling> siblings;
  const std::vector<JointDocument> documents = SplitJoints(root, overrides);
  ModelFiles models;
  CheckUnitsOfJoints(written, root, documents, root.place, &models);
  for (size_t i = 0; i < documents.size(); ++i) {
    if (documents[i].name == *joint) {
      chosen = StackOfDocument(root, documents, i, root.place, &models);
    } else {
      siblings.push_back({.name = documents[i].name, .suffix = SuffixOf(documents[i])});
    }
  }
  if (!chosen) throw InputError("--joint: found " + Quoted(*joint) + ", allowed " + QuotedList(names));
  const LimbSection limb = ReadLimbSection(root, chosen->plant.rate_hz);
  for (Sibling& sibling : siblings) {
    sibling.silence_s = AllowedSilence(*chosen, limb);
    chosen->bus.sibling_suffixes.push_back(sibling.suffix);
  }
  chosen->siblings = std::move(siblings);
  chosen->joints_concern_each_other = limb.on_joint_fault == OnJointFault::kAllToZero;
  const TomlNode* bus = root.Find("bus");
  const TomlNode* suffix = bus != nullptr ? bus->Find("channel_suffix") : nullptr;
  chosen->bus.limb_suffix = suffix != nullptr ? suffix->text : "";
  chosen->without_its_arm = root.Find("arm") != nullptr;
  return *chosen;
}

std::string ArmRemark(const StackConfig& config) {
  if (!config.without_its_arm) return "";
  return "the [arm] of " + config.file +
         " is left out: loads and margins are those of the joint alone, with J_a and mgl of its model";
}

bool IsLimbFile(const std::string& file) { return HasJoints(ReadConfigDocument(file)); }

LimbConfig LoadLimbConfig(const std::string& file, const std::vector<std::string>& overrides) {
  TomlNode root = ReadConfigDocument(file);
  std::vector<std::string> others = overrides;
  if (const auto joint = TakeJointChoice(&others)) {
    throw InputError("--joint: found " + Quoted(*joint) + ", allowed for a program of one joint's stack");
  }
  const std::vector<std::string> written = ModelsOfJoints(root);
  ApplyOverrides(others, &root);
  if (!HasJoints(root)) throw InputError(file + ": found no [[joint]] section, allowed one or more");
  const std::vector<JointDocument> documents = SplitJoints(root, others);
  ModelFiles models;
  CheckUnitsOfJoints(written, root, documents, file, &models);
  LimbConfig limb;
  for (size_t i = 0; i < documents.size(); ++i) {
    limb.joints.push_back({documents[i].name, StackOfDocument(root, documents, i, file, &models)});
  }
  TomlNode common = documents.front().root;
  const TomlNode* bus = root.Find("bus");
  common.Erase("bus");
  if (bus != nullptr) common.members.push_back({"bus", *bus});
  PutProcesses(root, &common);
  limb.common = StackOf(&common, file, &models);
  for (const JointConfig& joint : limb.joints) {
    limb.common.joints.push_back(joint.name);
    limb.common.bus.joint_suffixes.push_back(joint.config.bus.channel_suffix);
  }
  limb.limb = ReadLimbSection(root, limb.common.plant.rate_hz);
  limb.arm = ArmOf(root, limb.joints);
  limb.common.joints_concern_each_other = limb.limb.on_joint_fault == OnJointFault::kAllToZero;
  CheckProcesses(limb.common);
  if (limb.arm) CheckArmIsWhole(limb.common);
  limb.common.agreed = AgreedByAll(limb.joints);
  limb.common.text = FormatToml(WholeDocument(root, limb));
  return limb;
}

StackConfig LoadCommonConfig(const std::string& file, const std::vector<std::string>& overrides) {
  std::vector<std::string> others = overrides;
  if (TakeJointChoice(&others) || !IsLimbFile(file)) return LoadStackConfig(file, overrides);
  return LoadLimbConfig(file, overrides).common;
}

}  // namespace hydro::settings
