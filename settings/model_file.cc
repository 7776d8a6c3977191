#include "settings/model_file.h"

#include <algorithm>
#include <cmath>

#include "base/file_kind.h"
#include "base/number_text.h"
#include "base/units.h"
#include "model/equations/equations.h"
#include "model/terms/parameter_info.h"
#include "settings/effect_file.h"
#include "settings/effect_sections.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

constexpr char kUnitsAllowed[] = "\"si\", or a table as { length = \"mm\", force = \"N\", arm = \"rad\" }";

// Reads `key` in a table of units: one of the names in `allowed`, or `absent` if the key is missing.
std::string_view ReadUnit(SectionReader& section, const std::string& key,
                          const std::vector<std::string>& allowed, std::string_view absent) {
  std::vector<std::pair<std::string, std::string_view>> choices;
  choices.reserve(allowed.size());
  for (const std::string& name : allowed) choices.emplace_back(name, UnitPowers(name)->front().name);
  section.Choice(key, choices, &absent);
  return absent;
}

// Reads units = "si", or a table of names. In every system, time, the motor's angle and the command are in s,
// rad and V.
UnitSystem ReadUnits(SectionReader& document) {
  UnitSystem units;
  const TomlNode* node = document.Take("units");
  if (node == nullptr) return units;
  if (node->is(TomlNode::Kind::kString) && node->text == "si") return kSiUnits;
  if (!node->is(TomlNode::Kind::kTable)) throw document.Error("units", node->Shown(), kUnitsAllowed);
  SectionReader section(*node, "units");
  units.length = ReadUnit(section, "length", LengthUnits(), units.length);
  units.force = ReadUnit(section, "force", ForceUnits(), units.force);
  ReadUnit(section, "time", {"s"}, "s");
  ReadUnit(section, "angle", {"rad"}, "rad");
  units.linear_arm = ReadUnit(section, "arm", {"rad", std::string(units.length)}, "rad") != "rad";
  section.Finish();
  return units;
}

TomlNode UnitsNode(const UnitSystem& units) {
  if (units == kSiUnits) return StringNode("si");
  TomlNode table;
  table.members.push_back({"length", StringNode(std::string(units.length))});
  table.members.push_back({"force", StringNode(std::string(units.force))});
  if (units.linear_arm) table.members.push_back({"arm", StringNode(std::string(units.length))});
  return table;
}

// Reads c itself, or r and d, which give it: c = r^2 d / 2, eqs. (6), (7).
void ReadDisplacement(SectionReader& section, const model::ParameterInfo& info, const UnitSystem& units,
                      double* c) {
  double r = 0;
  double d = 0;
  const bool has_c = section.Number("c", c, RangeOf(info));
  const bool has_r = section.Number("r", &r, kPositive);
  const bool has_d = section.Number("d", &d, kPositive);
  if (has_c && (has_r || has_d)) {
    throw section.Error(has_r ? "r" : "d", "it beside c", "r and d, or c, not both");
  }
  if (has_r) section.Require("d", "a finite number above 0 (depth of the actuator; r and d give c)");
  if (has_d) section.Require("r", "a finite number above 0 (radius of the actuator; r and d give c)");
  if (!has_r && !has_d) section.Require("c", Wanted(info, units) + ", or r and d");
  if (has_r && has_d) {
    *c = r * r * d / 2;
    if (!RangeOf(info).Holds(*c)) {
      throw section.Error("r", "r^2 d / 2 = " + ShortestNumber(*c), RangeOf(info).AllowedInsteadOf(*c));
    }
  }
}

// A base parameter that is the mean of two sides, and the names of those sides.
struct SideNames {
  const char* mean;
  const char* first;
  const char* second;
  const char* effect;  // which holds their difference
};

constexpr SideNames kSides[] = {{"c", "c_1", "c_2", "actuator.unequal_areas"},
                                {"V_ms", "V_1", "V_2", "actuator.unequal_volumes"},
                                {"D", "D_1", "D_2", "pump.unequal_displacements"}};

model::EffectDescription SideDifference(const SideNames& names, double difference) {
  return {.id = names.effect, .parameters = {{"difference", difference}}, .names = {}};
}

// Of ratios from its inverse to this, the difference is within the effect's bounds, which are symmetric.
double LargestRatio(const model::ParameterInfo& difference) {
  return std::round((1 + difference.max) / (1 - difference.max));
}

// The error of the effect would name its difference, which nobody wrote.
void RequireRatio(const SectionReader& section, const SideNames& names, double first, double second) {
  const model::ParameterInfo& bounds = model::FindEffect(names.effect)->parameters.front();
  if (RangeOf(bounds).Holds((second - first) / (first + second))) return;
  const std::string largest = ShortNumber(LargestRatio(bounds)), of = names.first;
  throw section.Error(names.second, ShortNumber(second) + " beside " + of + " = " + ShortNumber(first),
                      names.second + (" from " + of) + "/" + largest + " to " + largest + " " + of);
}

// Reads c_1 and c_2 in place of c, and so on. Returns false where the file has neither.
bool ReadSides(SectionReader& section, const SideNames& names, const model::ParameterInfo& info,
               const UnitSystem& units, double* mean, std::vector<model::EffectDescription>* effects) {
  double first = 0, second = 0;
  const std::string wanted = Wanted(info, units);
  const bool has_first = section.Number(names.first, &first, RangeOf(info));
  const bool has_second = section.Number(names.second, &second, RangeOf(info));
  if (!has_first && !has_second) return false;
  section.Require(names.first, wanted + " (of side 1, beside " + names.second + ")");
  section.Require(names.second, wanted + " (of side 2, beside " + names.first + ")");
  if (section.Take(names.mean) != nullptr) {
    throw section.Error(
        names.mean, "it beside " + std::string(names.first),
        std::string(names.first) + " and " + names.second + ", or " + names.mean + ", not both");
  }
  *mean = (first + second) / 2;
  if (first != second) {
    effects->push_back(SideDifference(names, (second - first) / (first + second)));
    if (has_first && has_second) RequireRatio(section, names, first, second);
  }
  return true;
}

// Throws InputError for a model whose parts contradict each other, for example two accumulators.
void CheckEquations(const model::ModelDescription& description, const std::string& file) {
  try {
    const model::Equations accepted(description, {});
  } catch (const model::ModelError& error) {
    throw InputError(file + ": " + error.what());
  }
}

// With an area_ratio, c_2 over c_1, c is the mean of the two sides.
void ReadAreaRatio(SectionReader& section, bool has_sides, std::vector<model::EffectDescription>* effects) {
  double ratio = 1;
  const double largest = LargestRatio(model::FindEffect(kSides[0].effect)->parameters.front());
  if (!section.Number("area_ratio", &ratio, {.min = 1 / largest, .max = largest})) return;
  if (has_sides)
    throw section.Error("area_ratio", "it beside c_1", "c_1 and c_2, or c and area_ratio, not both");
  if (ratio != 1) effects->push_back(SideDifference(kSides[0], (ratio - 1) / (ratio + 1)));
}

// Reads [parameters]. A difference between the two sides becomes an effect, because that is its form in the
// equations.
void ReadParameters(SectionReader& section, model::ModelDescription* model) {
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    const model::ParameterInfo& info = parameter.info;
    double* value = &(model->parameters.*parameter.member);
    bool has_sides = false;
    for (const SideNames& names : kSides) {
      if (info.name == names.mean)
        has_sides = ReadSides(section, names, info, model->units, value, &model->effects);
    }
    if (info.name == "c") ReadAreaRatio(section, has_sides, &model->effects);
    if (has_sides) continue;
    if (info.name == "c") {
      ReadDisplacement(section, info, model->units, value);
    } else {
      section.Number(info.name, value, RangeOf(info));
      section.Require(info.name, Wanted(info, model->units));
    }
  }
  section.Finish();
}

// Throws InputError where [effects] gives the difference of two sides that [parameters] has already given.
void CheckSides(const SectionReader& effects, const std::vector<model::EffectDescription>& sides) {
  for (const model::EffectDescription& side : sides) {
    if (!effects.Has(side.id)) continue;
    throw effects.Error("\"" + side.id + "\"", "it beside unequal sides in [parameters]", "one of the two");
  }
}

// The uncertainty of a mean from those of its two sides: the larger one, because an error that both share is
// one of the mean. What one of them leaves out has the deviation of its kind. False where both are left out.
bool ReadSideUncertainty(SectionReader& section, const SideNames& names, double of_its_kind, double* value) {
  double first = of_its_kind, second = of_its_kind;
  const bool has_first = section.Number(names.first, &first, kPositive);
  const bool has_second = section.Number(names.second, &second, kPositive);
  if (!has_first && !has_second) return false;
  if (section.Has(names.mean)) {
    const std::string sides = std::string(names.first) + " and " + names.second;
    throw section.Error(names.mean, "it beside " + std::string(has_first ? names.first : names.second),
                        sides + ", or " + names.mean + ", not both");
  }
  *value = std::max(first, second);
  return true;
}

// [uncertainty]: relative standard deviations by base parameter.
std::map<std::string, double> ReadUncertainty(SectionReader section) {
  std::map<std::string, double> uncertainty;
  double value = 0;
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    const std::string& name = parameter.info.name;
    for (const SideNames& sides : kSides) {
      if (name == sides.mean && ReadSideUncertainty(section, sides, parameter.uncertainty, &value))
        uncertainty[name] = value;
    }
    if (section.Number(name, &value, kPositive)) uncertainty[name] = value;
  }
  section.Finish();
  return uncertainty;
}

}  // namespace

namespace {

model::ModelDescription ReadModel(const TomlNode& root) {
  SectionReader document(root, "");
  model::ModelDescription description;
  document.Text("name", &description.name);
  description.units = ReadUnits(document);
  SectionReader parameters = document.Section("parameters");
  document.Require("parameters", "a section [parameters]");
  SectionReader effects = document.Section("effects");
  description.uncertainty = ReadUncertainty(document.Section("uncertainty"));
  document.Finish();

  ReadParameters(parameters, &description);
  CheckSides(effects, description.effects);
  for (model::EffectDescription& effect :
       ReadEffects(std::move(effects), root.Find("effects"), description.units)) {
    description.effects.push_back(std::move(effect));
  }
  return description;
}

}  // namespace

model::ModelDescription ParseModel(const std::string& text, const std::string& name_for_messages) {
  TomlNode root = ParseToml(text, name_for_messages);
  root.place = name_for_messages;
  return ReadModel(root);
}

UnitSystem ParseModelUnits(const std::string& text, const std::string& name_for_messages) {
  TomlNode root = ParseToml(text, name_for_messages);
  root.place = name_for_messages;
  SectionReader document(root, "");
  return ReadUnits(document);
}

std::string UnitsText(const UnitSystem& units) {
  if (units == UnitSystem{}) return "";
  TomlNode root;
  root.members.push_back({"units", UnitsNode(units)});
  return FormatToml(root);
}

namespace {

ModelWithText WithDefinitions(const std::string& text, const std::string& file) {
  ModelWithText model{text, {}};
  RequireKind(FileKind::kModel, model.text, file, "a model");
  TomlNode root = ParseToml(model.text, file);
  root.place = file;
  if (IncludeDefinitions(&root, file)) model.text = FormatToml(root);
  model.description = ReadModel(root);
  CheckEquations(model.description, file);
  return model;
}

}  // namespace

ModelWithText LoadModelWithText(const std::string& file) { return WithDefinitions(ReadTextFile(file), file); }

ModelFiles::File& ModelFiles::Read(const std::string& file) {
  const auto known = files_.find(file);
  return known != files_.end() ? known->second : files_.emplace(file, File{ReadTextFile(file)}).first->second;
}

const UnitSystem& ModelFiles::Units(const std::string& file) {
  File& read = Read(file);
  if (!read.units) read.units = ParseModelUnits(read.text, file);
  return *read.units;
}

const ModelWithText& ModelFiles::Model(const std::string& file) {
  File& read = Read(file);
  if (!read.model) read.model = WithDefinitions(read.text, file);
  return *read.model;
}

model::ModelDescription LoadModelFile(const std::string& file) { return LoadModelWithText(file).description; }

std::string FormatModel(const model::ModelDescription& description) {
  TomlNode root;
  root.members.push_back({"name", StringNode(description.name)});
  if (description.units != UnitSystem{}) root.members.push_back({"units", UnitsNode(description.units)});
  TomlNode parameters;
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    parameters.members.push_back({parameter.info.name, NumberNode(description.parameters.*parameter.member)});
  }
  root.members.push_back({"parameters", std::move(parameters)});
  TomlNode uncertainty;
  for (const auto& [name, value] : description.uncertainty) {
    uncertainty.members.push_back({name, NumberNode(value)});
  }
  if (!uncertainty.members.empty()) root.members.push_back({"uncertainty", std::move(uncertainty)});
  TomlNode effects = EffectsNode(description.effects);
  if (!effects.members.empty()) root.members.push_back({"effects", std::move(effects)});
  return FormatToml(root);
}

}  // namespace hydro::settings
