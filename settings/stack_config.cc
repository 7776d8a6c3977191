#include "settings/stack_config.h"

#include <cmath>
#include <filesystem>

#include "base/file_kind.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "settings/config_entries.h"
#include "settings/joint_documents.h"
#include "settings/model_file.h"
#include "settings/overrides.h"
#include "settings/stack_checks.h"
#include "settings/stack_document.h"
#include "settings/stack_sections.h"
#include "settings/trajectory_spec.h"

namespace hydro::settings {
namespace {

// Reads everything except the model file.
StackConfig ReadDocument(TomlNode* root, const std::string& file) {
  root->place = file;
  StackConfig config;
  config.file = file;
  ReadSections(*root, file, &config);
  CheckTimes(*root, &config);
  CheckChoices(*root, config);

  TomlNode* model = root->Find("model");
  if (model != nullptr && config.model.motion) EmbedPoints(*config.model.motion, model->Find("motion"));
  EmbedPoints(config.reference.trajectory, root->Find("reference"));
  config.text = FormatToml(*root);
  return config;
}

StackConfig WithModel(TomlNode* root, const std::string& config_name, const std::string& model_text,
                      const std::string& model_name, FormerNames former) {
  ReadQuantities(root, ParseModelUnits(model_text, model_name), former);
  StackConfig config = ReadDocument(root, config_name);
  config.model.resolved_file = model_name;
  config.model.text = model_text;
  config.model.description = ParseModel(model_text, model_name);
  CheckAgainstModel(*root, &config);
  config.agreed = AgreedEntries(config);
  return config;
}

// Users often mistake the folder to which the model file's path is relative, so the message names it.
void RequireModelFile(const TomlNode& root, const std::string& named, const std::string& path) {
  std::error_code unknown;  // for a folder that cannot be read, which the file's reader reports
  if (std::filesystem::exists(path, unknown) || unknown) return;
  throw KeyError(root, "model.file", Quoted(named) + ", and there is no " + Quoted(path),
                 "a path that counts from the configuration's folder");
}

// The path of the model that `root` names. Throws InputError where there is no such file.
std::string ModelFileOf(const TomlNode& root, const std::string& name, const std::string& file) {
  if (name.empty()) return "";
  std::string path = PathBeside(file, name);
  RequireModelFile(root, name, path);
  return path;
}

// The units of the model that another one replaces. None where that model cannot be read, because nothing
// requires it.
std::optional<UnitSystem> UnitsOfReplacedModel(const std::string& name, const std::string& file,
                                               ModelFiles* models) {
  if (name.empty()) return UnitSystem{};
  try {
    return models->Units(PathBeside(file, name));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Lists units for people: "in, lbf, psi", and for a linear arm also the arm's unit.
std::string Named(const UnitSystem& units) {
  return std::string(units.length) + ", " + std::string(units.force) + ", " + units.UnitFor("psi") +
         (units.linear_arm ? " and an arm in " + units.UnitFor("rad", 1) : "");
}

// Checks that the configuration has no joints: a stack has only one.
void CheckHasNoJoints(const StackConfig& config) {
  for (const ProcessSection& process : config.processes) {
    if (process.joint.empty() && process.program != "hydro-limb") continue;
    throw KeyError(process.place, process.joint.empty() ? "process.program" : "process.joint",
                   Quoted(process.joint.empty() ? process.program : process.joint),
                   "it in a configuration with [[joint]] sections only");
  }
}

}  // namespace

TomlNode ReadConfigDocument(const std::string& file) {
  const std::string text = ReadTextFile(file);
  if (const auto kind = FindFileKind(text); kind == FileKind::kSidecar || kind == FileKind::kStudy)
    throw InputError(file + ": " + OtherKind(*kind, file, "the configuration of a stack"));
  TomlNode root = ParseToml(text, file);
  root.place = file;
  UsePresentNames(&root);
  if (root.Find("parameters") != nullptr && root.Find("model") == nullptr) {
    throw InputError(file +
                     ": found a model ([parameters]), allowed the configuration of a stack, which names its "
                     "model: [model] file = " +
                     Quoted(file));
  }
  return root;
}

std::string ModelNameIn(const TomlNode& root) {
  const TomlNode* model = root.Find("model");
  const TomlNode* name = model == nullptr ? nullptr : model->Find("file");
  return name != nullptr && name->is(TomlNode::Kind::kString) ? name->text : "";
}

UnitSystem UnitsOfModelIn(const TomlNode& root, const std::string& file, ModelFiles* models) {
  const std::string path = ModelFileOf(root, ModelNameIn(root), file);
  return path.empty() ? UnitSystem{} : models->Units(path);
}

// The numbers of the configuration keep the units of the model that it names itself.
void CheckUnitsOfOtherModel(const std::string& written, const TomlNode& root, const std::string& file,
                            ModelFiles* models) {
  if (ModelNameIn(root) == written) return;
  const std::string path = ModelFileOf(root, ModelNameIn(root), file);
  if (path.empty()) return;
  const std::optional<UnitSystem> was = UnitsOfReplacedModel(written, file, models);
  const UnitSystem is = models->Model(path).description.units;  // a file that is not a model has no units
  if (was) CheckNumbersKeepTheirUnits(root, root, *was, is);
}

void CheckNumbersKeepTheirUnits(const TomlNode& numbers, const TomlNode& root, const UnitSystem& was,
                                const UnitSystem& is) {
  if (was == is) return;
  const std::string number = FirstNumberThatChanges(numbers, was, is);
  if (number.empty()) return;
  throw KeyError(root, "model.file",
                 "a model in " + Named(is) + ", and numbers for one in " + Named(was) + " (" + number + ")",
                 "a model in the same units, or values with a unit of their own, such as \"2000 psi\"");
}

StackConfig StackOf(TomlNode* root, const std::string& file, ModelFiles* models) {
  CheckKeysHaveSections(*root);
  ReadQuantities(root, UnitsOfModelIn(*root, file, models));
  StackConfig config = ReadDocument(root, file);
  if (config.model.file.empty()) {
    throw KeyError(*root, "model.file", "nothing", "the path of a model file");
  }
  config.model.resolved_file = PathBeside(file, config.model.file);
  const ModelWithText& model = models->Model(config.model.resolved_file);
  config.model.text = model.text;
  config.model.description = model.description;
  CheckAgainstModel(*root, &config);
  config.agreed = AgreedEntries(config);
  RememberRead(config.bus.resolved_key_file);  // the code that opens the bus reads it
  return config;
}

StackConfig LoadStackConfig(const std::string& file, const std::vector<std::string>& overrides) {
  TomlNode root = ReadConfigDocument(file);
  std::vector<std::string> others = overrides;
  const std::optional<std::string> joint = TakeJointChoice(&others);
  if (HasJoints(root) || joint) return StackOfJoint(root, others, joint);
  for (const char* key : {"limb", "arm"}) {
    if (root.Find(key) != nullptr)
      throw KeyError(root, key, "it without joints", "it with [[joint]] sections");
  }
  const std::string written = ModelNameIn(root);
  ApplyOverrides(others, &root);
  ModelFiles models;
  CheckUnitsOfOtherModel(written, root, file, &models);
  StackConfig config = StackOf(&root, file, &models);
  CheckHasNoJoints(config);
  return config;
}

StackConfig ParseStackConfig(const std::string& config_text, const std::string& config_name,
                             const std::string& model_text, const std::string& model_name) {
  TomlNode root = ParseToml(config_text, config_name);
  return WithModel(&root, config_name, model_text, model_name, FormerNames::kAsMeant);
}

StackConfig Changed(const StackConfig& config, const std::vector<std::string>& changes, FormerNames former) {
  TomlNode root = ParseToml(config.text, config.file);
  ApplyOverrides(changes, &root);
  return WithModel(&root, config.file, config.model.text, config.model.resolved_file, former);
}

std::vector<std::string> JointSuffixes(const StackConfig& config) {
  return config.joints.empty() ? std::vector{config.bus.channel_suffix} : config.bus.joint_suffixes;
}

std::vector<std::string> StackSuffixes(const StackConfig& config) {
  std::vector<std::string> suffixes{config.bus.channel_suffix};
  suffixes.insert(suffixes.end(), config.bus.joint_suffixes.begin(), config.bus.joint_suffixes.end());
  return suffixes;
}

int64_t OldestPressureCommandTicks(const StackConfig& config) {
  return config.plant.command_delay_ticks + config.position_interval_ticks +
         static_cast<int64_t>(std::ceil(config.limits.stale_input_s * config.plant.rate_hz));
}

ReferenceSection ParseReference(const std::string& text) {
  const TomlNode root = ParseToml(text, "reference");
  ReferenceSection reference;
  ReadReference(SectionReader(root, "").Section("reference"), "", &reference);
  return reference;
}

std::string ReferenceText(const StackConfig& config) {
  TomlNode root = ParseToml(config.text, config.file);
  TomlNode alone;
  if (TomlNode* reference = root.Find("reference")) alone.members.push_back({"reference", *reference});
  return FormatToml(alone);
}

}  // namespace hydro::settings
