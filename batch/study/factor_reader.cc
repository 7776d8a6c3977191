#include "batch/study/factor_reader.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/tables/csv_text.h"
#include "base/word_list.h"
#include "batch/study/value.h"
#include "model/terms/parameter_info.h"

namespace hydro::batch {
namespace {

using settings::SectionReader;
using settings::TomlNode;
using Kind = TomlNode::Kind;

constexpr size_t kMostValues = 1'000'000;
constexpr double kLargestWhole = 0x1p53;  // up to here, a double can hold every whole number
constexpr double kFarthestDraw = 10;      // standard deviations; no normal draw lies so far from the mean

std::vector<std::string> ParameterNames() {
  std::vector<std::string> names;
  for (const model::BaseParameter& parameter : model::BaseParameters()) names.push_back(parameter.info.name);
  return names;
}

// The same for a parameter of an effect. `prefix` is the beginning of the key.
std::string WrongEffect(const Key& key, const std::string& prefix, const KeyScope& scope) {
  std::vector<std::string> ids;
  for (const model::EffectDescription& effect : scope.model->effects) {
    if (effect.id == key.effect) return "";
    ids.push_back(effect.id);
  }
  const model::EffectInfo* info = model::FindEffect(key.effect);
  if (info == nullptr) {
    for (const model::EffectInfo& each : model::EffectCatalogue()) ids.push_back(each.id);
    return prefix + " with an effect's id and its parameter, as in " + prefix +
           "pump.stribeck.static_excess" + DidYouMean(key.effect, ids);
  }
  std::vector<std::string> names;
  for (const model::ParameterInfo& parameter : info->parameters) names.push_back(parameter.name);
  if (std::ranges::find(names, key.parameter) != names.end()) return "";
  return prefix + key.effect + ". and one of " + QuotedList(names) + DidYouMean(key.parameter, names);
}

// What is wrong with a key, followed by ", allowed ..."; empty: nothing.
std::string WrongKey(const std::string& text, const KeyScope& scope) {
  const Key key = ParseKey(text);
  if (key.kind == KeyKind::kOwn) return text.empty() ? "a key" : "";
  if (key.kind == KeyKind::kConfiguration) {
    if (scope.has_config) return "";
    return "a name without a point in a study that has no config (above the first section of the file)";
  }
  const std::string prefix = text.substr(0, text.find(':') + 1);
  if (!scope.model) return prefix + " only in a study with a config or a model";
  if (key.kind == KeyKind::kMachine && !scope.has_config)
    return prefix + " only in a study with a config, whose hydro-sim has the machine";
  if (key.kind == KeyKind::kEffect || !key.effect.empty()) return WrongEffect(key, prefix, scope);
  const std::vector<std::string> names = ParameterNames();
  if (std::ranges::find(names, key.parameter) != names.end()) return "";
  return prefix + " and one of " + QuotedList(names) + DidYouMean(key.parameter, names);
}

std::string ReadKey(SectionReader* section, const KeyScope& scope) {
  std::string key;
  section->Require("key", "the key that varies");
  if (!section->Text("key", &key)) return key;
  const std::string wrong = WrongKey(key, scope);
  if (!wrong.empty()) throw section->Error("key", Quoted(key), wrong);
  return key;
}

std::vector<Value> ReadValues(SectionReader* section, const std::string& name) {
  const TomlNode* node = section->Take(name);
  std::vector<Value> values;
  if (node == nullptr) return values;
  const std::string allowed = "a list of numbers, texts, true or false";
  if (!node->is(Kind::kArray) || node->items.empty()) throw section->Error(name, node->Shown(), allowed);
  for (const TomlNode& item : node->items) {
    const auto value = ValueOf(item);
    if (!value) throw section->Error(name, item.Shown(), allowed);
    values.push_back(*value);
  }
  return values;
}

// Values from `from` to `to`, both included, evenly spaced or by equal factors.
std::vector<Value> Range(double from, double to, int steps, bool logarithmic) {
  std::vector<Value> values;
  for (int i = 0; i < steps; ++i) {
    const double part = steps == 1 ? 0 : static_cast<double>(i) / (steps - 1);
    double value = Between(from, to, part, logarithmic);
    if (i == 0) value = from;
    if (i > 0 && i == steps - 1) value = to;
    values.emplace_back(Rounded(value));
  }
  return values;
}

GridFactor ReadFactor(SectionReader section, const KeyScope& scope) {
  GridFactor factor;
  factor.key = ReadKey(&section, scope);
  factor.values = ReadValues(&section, "values");
  std::optional<double> from, to;
  section.Number("from", &from);
  section.Number("to", &to);
  int steps = 0;
  const bool has_steps = section.Integer("steps", &steps, 2, static_cast<int>(kMostValues));
  bool logarithmic = false;
  section.Choice<bool>("scale", {{"linear", false}, {"log", true}}, &logarithmic);
  section.Finish();
  if (!factor.values.empty()) {
    if (from || to || has_steps) throw section.Error("values", "from, to or steps beside it", "either");
    return factor;
  }
  if (!from && !to && !has_steps) throw section.Error("values", "nothing", "a list, or from, to and steps");
  if (!from || !to || !has_steps)
    throw section.Error(!from ? "from" : !to ? "to" : "steps", "nothing", "all of from, to and steps");
  if (logarithmic && !(*from > 0 && *to > 0)) {
    throw section.Error("scale", "\"log\" from " + ShortestNumber(*from) + " to " + ShortestNumber(*to),
                        "bounds above 0");
  }
  factor.values = Range(*from, *to, steps, logarithmic);
  return factor;
}

template <class Read>
void ForEachItem(SectionReader* study, const std::string& name, const Read& read) {
  const TomlNode* node = study->Take(name);
  if (node == nullptr) return;
  if (!node->is(Kind::kArray)) throw study->Error(name, node->Shown(), "sections [[" + name + "]]");
  for (const TomlNode& item : node->items) {
    if (!item.is(Kind::kTable)) throw study->Error(name, item.Shown(), "sections [[" + name + "]]");
    read(study->Item(item, name));
  }
}

void ReadRows(SectionReader* section, RowList* list) {
  const TomlNode* rows = section->Take("rows");
  const std::string allowed =
      "a list of rows, each with " + std::to_string(list->keys.size()) + " values, one for each key";
  if (rows == nullptr || !rows->is(Kind::kArray) || rows->items.empty())
    throw section->Error("rows", rows == nullptr ? "nothing" : rows->Shown(), allowed);
  for (const TomlNode& row : rows->items) {
    std::vector<Value> values;
    for (const TomlNode& item : row.items) {
      const auto value = ValueOf(item);
      if (!value) throw section->Error("rows", item.Shown(), allowed);
      values.push_back(*value);
    }
    if (!row.is(Kind::kArray) || values.size() != list->keys.size()) {
      throw section->Error("rows",
                           "row " + std::to_string(list->rows.size() + 1) + " with " +
                               std::to_string(values.size()) + " values",
                           allowed);
    }
    list->rows.push_back(std::move(values));
  }
}

void ReadCsvRows(const std::string& csv, const std::string& name, RowList* list) {
  tables::CsvText text(csv, name);
  list->keys.insert(list->keys.end(), text.names().begin(), text.names().end());
  while (text.Next()) {
    std::vector<Value> values;
    for (size_t i = 0; i < list->keys.size(); ++i) {
      if (text.cell(i).empty()) throw text.CellError(i, "a value");
      values.push_back(ValueOfCell(tables::CellText(text.cell(i))));
    }
    list->rows.push_back(std::move(values));
  }
}

void ReadBounds(SectionReader* section, Draw* draw) {
  const bool bounded =
      draw->distribution == Distribution::kUniform || draw->distribution == Distribution::kLogUniform;
  const double floor = draw->distribution == Distribution::kLogUniform ? 0 : -HUGE_VAL;
  std::optional<double> min, max;
  section->Number("min", &min, {.min = floor, .min_allowed = false});
  section->Number("max", &max);
  if (bounded && (!min || !max)) throw section->Error(min ? "max" : "min", "nothing", "a number");
  draw->min = min.value_or(draw->min);
  draw->max = max.value_or(draw->max);
  if (draw->min >= draw->max)
    throw section->Error("max", ShortestNumber(draw->max),
                         "a number above min, " + ShortestNumber(draw->min));
  if (draw->distribution != Distribution::kUniform) return;
  section->Boolean("whole", &draw->whole);
  if (draw->whole && (std::floor(draw->min) != draw->min || std::floor(draw->max) != draw->max))
    throw section->Error("whole", "true beside bounds with a fraction", "whole min and max");
  if (draw->whole && (draw->min < -kLargestWhole || draw->max > kLargestWhole)) {
    throw section->Error(
        "whole", "true from " + ShortestNumber(draw->min) + " to " + ShortestNumber(draw->max),
        "bounds from -" + ShortestNumber(kLargestWhole) + " to " + ShortestNumber(kLargestWhole));
  }
}

void ReadNormal(SectionReader* section, Draw* draw) {
  section->Require("mean", "a number");
  section->Require("standard_deviation", "a number above 0");
  section->Number("mean", &draw->mean);
  section->Number("standard_deviation", &draw->standard_deviation, settings::kPositive);
  ReadBounds(section, draw);
  if (!std::isfinite(std::fabs(draw->mean) + kFarthestDraw * draw->standard_deviation)) {
    throw section->Error("standard_deviation", ShortestNumber(draw->standard_deviation),
                         "one of which ten are a number");
  }
  if (draw->mean < draw->min || draw->mean > draw->max)
    throw section->Error("mean", ShortestNumber(draw->mean), "a number between min and max");
}

// The parameters for which a key with "uncertainty" stands: one, or with model:* or machine:* all that are
// not 0.
void AddUncertain(const SectionReader& section, const std::string& key, const KeyScope& scope,
                  std::vector<Draw>* draws) {
  const std::string prefix = key.substr(0, key.find(':') + 1);
  const std::string name_of_all = prefix + "*";
  const bool known = prefix == "model:" || prefix == "machine:";
  if (!scope.model || !known)
    throw section.Error(
        "key", Quoted(key),
        "\"model:\" or \"machine:\" with a parameter's name or * (all), in a study with a config "
        "or a model");
  if (prefix == "machine:" && !scope.has_config)
    throw section.Error("key", Quoted(key), "\"machine:\" only in a study with a config");
  const size_t before = draws->size();
  for (size_t base = 0; base < model::BaseParameters().size(); ++base) {
    const std::string& name = model::BaseParameters()[base].info.name;
    model::Parameters parameters = scope.model->parameters;
    const double value = model::BaseValue(parameters, base);
    const double deviation = model::UncertaintyOf(*scope.model, base);
    if (key != name_of_all && key != prefix + name) continue;
    if (key == name_of_all && (value == 0 || deviation == 0)) continue;
    Draw draw;
    draw.key = prefix + name;
    draw.distribution = Distribution::kUncertainty;
    draw.mean = value;
    draw.standard_deviation = deviation;
    draws->push_back(draw);
  }
  if (draws->size() == before) throw section.Error("key", Quoted(key), WrongKey(key, scope));
}

void AddDraws(SectionReader section, const KeyScope& scope, std::vector<Draw>* draws) {
  Draw draw;
  section.Require("distribution", "\"uniform\", \"log_uniform\", \"normal\", \"choice\" or \"uncertainty\"");
  section.Choice<Distribution>("distribution",
                               {{"uniform", Distribution::kUniform},
                                {"log_uniform", Distribution::kLogUniform},
                                {"normal", Distribution::kNormal},
                                {"choice", Distribution::kChoice},
                                {"uncertainty", Distribution::kUncertainty}},
                               &draw.distribution);
  if (draw.distribution == Distribution::kUncertainty) {
    std::string key;
    section.Require("key", "\"model:*\" or a parameter of the model");
    section.Text("key", &key);
    section.Finish();
    AddUncertain(section, key, scope, draws);
    return;
  }
  draw.key = ReadKey(&section, scope);
  if (draw.distribution == Distribution::kNormal) {
    ReadNormal(&section, &draw);
  } else if (draw.distribution == Distribution::kChoice) {
    draw.choices = ReadValues(&section, "values");
    if (draw.choices.empty()) throw section.Error("values", "nothing", "a list of values");
  } else {
    ReadBounds(&section, &draw);
  }
  section.Finish();
  draws->push_back(draw);
}

}  // namespace

std::vector<GridFactor> ReadGrid(SectionReader* study, const KeyScope& scope) {
  std::vector<GridFactor> grid;
  ForEachItem(study, "grid", [&](const SectionReader& item) { grid.push_back(ReadFactor(item, scope)); });
  return grid;
}

RowList ReadList(SectionReader section, const KeyScope& scope, const std::string& csv,
                 const std::string& csv_name) {
  RowList list;
  if (!csv_name.empty()) {
    if (section.Has("keys") || section.Has("rows"))
      throw section.Error("file", "keys or rows beside it", "either");
    ReadCsvRows(csv, csv_name, &list);
  } else if (section.Has("keys") || section.Has("rows")) {
    for (const Value& key : ReadValues(&section, "keys")) list.keys.push_back(PlainText(key));
    ReadRows(&section, &list);
  }
  section.Finish();
  for (const std::string& key : list.keys) {
    const std::string wrong = WrongKey(key, scope);
    if (wrong.empty()) continue;
    if (!csv_name.empty())
      throw InputError(csv_name + ": column: found " + Quoted(key) + ", allowed " + wrong);
    throw section.Error("keys", Quoted(key), wrong);
  }
  return list;
}

std::vector<Draw> ReadDraws(SectionReader* study, const KeyScope& scope) {
  std::vector<Draw> draws;
  ForEachItem(study, "draw", [&](const SectionReader& item) { AddDraws(item, scope, &draws); });
  return draws;
}

}  // namespace hydro::batch
