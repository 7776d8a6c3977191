#include "settings/effect_sections.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/word_list.h"
#include "model/effects/catalogue.h"
#include "model/terms/parameter_info.h"
#include "settings/effect_file.h"

namespace hydro::settings {
namespace {

// What was found wrong in a list of numbers; "" if nothing is wrong.
std::string FaultIn(const TomlNode& node, const model::ParameterInfo& info) {
  if (!node.is(TomlNode::Kind::kArray)) return node.Shown();
  const NumberRange range = RangeOf(info);
  const bool places = info.list == model::List::kPlaces;
  for (size_t i = 0; i < node.items.size(); ++i) {
    const TomlNode& item = node.items[i];
    if (!item.is_number() || !range.Holds(item.AsDouble())) return item.Shown();
    if (places && i > 0 && !(item.AsDouble() > node.items[i - 1].AsDouble())) {
      return item.Shown() + " after " + node.items[i - 1].Shown();
    }
  }
  return node.items.size() < (places ? 2u : 1u) ? "a list of " + std::to_string(node.items.size()) : "";
}

std::string AllowedNumbers(const model::ParameterInfo& info, const UnitSystem& units) {
  if (info.list == model::List::kPlaces) {
    return "a list of two or more finite numbers, each above the one before (" + info.meaning + ")";
  }
  return "a list of finite numbers (" + info.UnitIn(units) + ", " + info.meaning + ")";
}

std::string AllowedNames(const model::ParameterInfo& info) {
  return "a list with some of " + QuotedList(info.names) + " (" + info.meaning + ")";
}

bool IsKnown(const TomlNode& item, const model::ParameterInfo& info) {
  return item.is(TomlNode::Kind::kString) &&
         std::find(info.names.begin(), info.names.end(), item.text) != info.names.end();
}

void ReadNames(SectionReader* section, const model::ParameterInfo& info, model::EffectDescription* effect) {
  section->Require(info.name, AllowedNames(info));
  const TomlNode* node = section->Take(info.name);
  if (node == nullptr) return;
  if (!node->is(TomlNode::Kind::kArray)) throw section->Error(info.name, node->Shown(), AllowedNames(info));
  for (const TomlNode& item : node->items) {
    if (!IsKnown(item, info)) {
      throw section->Error(info.name, item.Shown(), AllowedNames(info) + DidYouMean(item.text, info.names));
    }
    effect->name_lists[info.name].push_back(item.text);
  }
  if (node->items.empty()) throw section->Error(info.name, "an empty list", AllowedNames(info));
}

void ReadNumbers(SectionReader* section, const model::ParameterInfo& info, const UnitSystem& units,
                 model::EffectDescription* effect) {
  if (!info.optional) section->Require(info.name, AllowedNumbers(info, units));
  const TomlNode* node = section->Take(info.name);
  if (node == nullptr) return;
  const std::string fault = FaultIn(*node, info);
  if (!fault.empty()) throw section->Error(info.name, fault, AllowedNumbers(info, units));
  std::vector<double>& list = effect->lists[info.name];
  list.reserve(node->items.size());
  for (const TomlNode& item : node->items) list.push_back(item.AsDouble());
}

model::EffectDescription ReadEffect(SectionReader section, const model::EffectInfo& info,
                                    const UnitSystem& units) {
  model::EffectDescription effect;
  effect.id = info.id;
  if (section.Has("definition"))
    section.Take("definition");  // else it is not among the keys that errors list
  for (const model::ParameterInfo& parameter : info.parameters) {
    if (parameter.list == model::List::kNames) {
      ReadNames(&section, parameter, &effect);
    } else if (parameter.list != model::List::kNone) {
      ReadNumbers(&section, parameter, units, &effect);
    } else if (parameter.is_name()) {
      std::vector<std::pair<std::string, std::string>> choices;
      for (const std::string& name : parameter.names) choices.emplace_back(name, name);
      section.Choice(parameter.name, choices, &effect.names[parameter.name]);
      section.Require(parameter.name, QuotedList(parameter.names) + " (" + parameter.meaning + ")");
    } else {
      double value = 0;
      if (section.Number(parameter.name, &value, RangeOf(parameter)))
        effect.parameters[parameter.name] = value;
      if (!parameter.optional) section.Require(parameter.name, Wanted(parameter, units));
    }
  }
  section.Finish();
  if (info.fault == nullptr) return effect;
  const std::optional<model::ListFault> fault = info.fault(effect);
  if (fault.has_value()) throw section.Error(fault->parameter, fault->found, fault->allowed);
  return effect;
}

// The table that describes an effect as text, if its section has one.
const TomlNode* DefinitionOf(const TomlMember& effect) {
  if (!effect.second.is(TomlNode::Kind::kTable)) return nullptr;
  const TomlNode* definition = effect.second.Find("definition");
  if (definition == nullptr || definition->is(TomlNode::Kind::kTable)) return definition;
  throw KeyError(definition->place, "effects." + effect.first + ".definition", definition->Shown(),
                 "the effect's table, or in a model's file the name of its file");
}

}  // namespace

std::vector<model::EffectDescription> ReadEffects(SectionReader section, const TomlNode* table,
                                                  const UnitSystem& units) {
  std::vector<model::EffectDescription> effects;
  if (table == nullptr) return effects;
  std::vector<std::string> known;
  for (const model::EffectInfo& info : model::EffectCatalogue()) known.push_back(info.id);
  for (const auto& member : table->members) {
    if (const TomlNode* definition = DefinitionOf(member)) {
      const std::string path = "effects." + member.first + ".definition";
      const auto formulas = ReadFormulas(*definition, path, member.first);
      effects.push_back(ReadEffect(section.Section(member.first), formulas->info(), units));
      effects.back().formulas = formulas;
      continue;
    }
    // Without quotes, [effects.pump.stribeck] is a table in a table.
    if (const model::EffectInfo* info = model::FindEffect(member.first)) {
      SectionReader reader = section.Section(member.first);
      effects.push_back(ReadEffect(std::move(reader), *info, units));
      continue;
    }
    std::string id = member.first;
    if (member.second.is(TomlNode::Kind::kTable) && member.second.members.size() == 1 &&
        model::FindEffect(id + "." + member.second.members[0].first) != nullptr) {
      id += "." + member.second.members[0].first;
      throw InputError(member.second.place + ": effects: found [effects." + id + "], allowed [effects.\"" +
                       id + "\"]: the id needs quotes");
    }
    throw InputError(member.second.place + ": effects: found the unknown effect " + Quoted(id) +
                     ", allowed " + QuotedList(known) + DidYouMean(id, known) +
                     "; one of your own: definition = \"FILE.toml\" in its section (docs/effects.md)");
  }
  return effects;
}

TomlNode EffectsNode(const std::vector<model::EffectDescription>& effects) {
  TomlNode node;
  for (const model::EffectDescription& effect : effects) {
    TomlNode table;
    for (const auto& [name, value] : effect.parameters) table.members.push_back({name, NumberNode(value)});
    for (const auto& [name, value] : effect.names) table.members.push_back({name, StringNode(value)});
    for (const auto& [name, list] : effect.name_lists) {
      std::vector<TomlNode> items;
      items.reserve(list.size());
      for (const std::string& value : list) items.push_back(StringNode(value));
      table.members.push_back({name, ArrayNode(std::move(items))});
    }
    for (const auto& [name, list] : effect.lists) {
      std::vector<TomlNode> items;
      items.reserve(list.size());
      for (const double value : list) items.push_back(NumberNode(value));
      table.members.push_back({name, ArrayNode(std::move(items))});
    }
    if (const auto formulas = model::FormulasOf(effect))
      table.members.push_back({"definition", FormulasNode(*formulas)});
    node.members.push_back({effect.id, std::move(table)});
  }
  return node;
}

}  // namespace hydro::settings
