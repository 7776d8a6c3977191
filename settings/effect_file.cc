#include "settings/effect_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/text_file.h"
#include "model/effects/catalogue.h"
#include "model/effects/formulas.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

using model::Role;
using model::Scale;

const std::vector<std::pair<std::string, Role>>& Roles() {
  static const std::vector<std::pair<std::string, Role>> roles = {
      {"size", Role::kSize},
      {"time", Role::kTime},
      {"frequency", Role::kFrequency},
      {"periods", Role::kPeriods},
      {"torque_wave", Role::kTorqueWave},
      {"displacement_wave", Role::kDisplacementWave},
      {"phase", Role::kPhase},
      {"channel", Role::kChannel}};
  return roles;
}

const std::vector<std::pair<std::string, Scale>>& Scales() {
  static const std::vector<std::pair<std::string, Scale>> scales = {{"one", Scale::kOne},
                                                                    {"torque", Scale::kTorque},
                                                                    {"speed", Scale::kSpeed},
                                                                    {"pressure", Scale::kPressure},
                                                                    {"charge", Scale::kCharge},
                                                                    {"sample", Scale::kSample},
                                                                    {"rate", Scale::kRate},
                                                                    {"torque_rate", Scale::kTorqueRate},
                                                                    {"flow", Scale::kFlow},
                                                                    {"arm_stiffness", Scale::kArmStiffness},
                                                                    {"arm_damping", Scale::kArmDamping},
                                                                    {"oil_stiffness", Scale::kOilStiffness}};
  return scales;
}

template <class Value>
std::string NameOf(const std::vector<std::pair<std::string, Value>>& names, Value value) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const auto& one) { return one.second == value; });
  return found->first;
}

// Reads a string or a list of strings.
std::vector<std::string> Texts(SectionReader& section, const std::string& key, const std::string& allowed) {
  const TomlNode* node = section.Take(key);
  if (node == nullptr) return {};
  if (node->is(TomlNode::Kind::kString)) return {node->text};
  if (!node->is(TomlNode::Kind::kArray)) throw section.Error(key, node->Shown(), allowed);
  std::vector<std::string> texts;
  for (const TomlNode& item : node->items) {
    if (!item.is(TomlNode::Kind::kString)) throw section.Error(key, item.Shown(), allowed);
    texts.push_back(item.text);
  }
  return texts;
}
constexpr char kStatements[] = "a statement as \"arm_torque -= stiffness * alpha\", or a list of them";

// The ids of curves through what no known effect explains.
constexpr char kOfClosures[] = "closure.";

// The key of an effect's section in a model's file that is no parameter (settings/effect_sections.cc).
constexpr char kDefinition[] = "definition";

constexpr size_t kMostNames = 256;  // of parameters, states and so on; an effect has a few

// The names of the tables in a table. Throws InputError where there are more than any effect has.
std::vector<std::string> Keys(const TomlNode& table, const std::string& key) {
  std::vector<std::string> keys;
  const TomlNode* inner = table.Find(key);
  if (inner == nullptr || !inner->is(TomlNode::Kind::kTable))
    return keys;  // SectionReader reports what is wrong
  const size_t count = inner->members.size();
  if (count > kMostNames)
    throw KeyError(inner->place, key, std::to_string(count) + " of them",
                   "up to " + std::to_string(kMostNames));
  for (const TomlMember& member : inner->members) keys.push_back(member.first);
  return keys;
}

// Reports and errors print these texts in the middle of a line, which a text of several lines would break.
void ReadLine(SectionReader& section, const std::string& key, std::string* line) {
  section.Text(key, line);
  const auto breaks = [](unsigned char c) { return c != '\t' && std::iscntrl(c) != 0; };
  if (std::any_of(line->begin(), line->end(), breaks))
    throw section.Error(key, Quoted(*line), "one line, without control characters");
}

void ReadStarts(SectionReader& section, model::ParameterInfo* info) {
  const TomlNode* node = section.Take("starts");
  if (node == nullptr) return;
  const auto bad = [&](const std::string& found) {
    return section.Error("starts", found, "a list of numbers, in the unit that \"scale\" says");
  };
  if (!node->is(TomlNode::Kind::kArray)) throw bad(node->Shown());
  if (node->items.empty()) throw bad("an empty list");
  info->starts.clear();
  for (const TomlNode& item : node->items) {
    if (!item.is_number() || !kAnyNumber.Holds(item.AsDouble())) throw bad(item.Shown());
    info->starts.push_back(item.AsDouble());
  }
}

void ReadBound(SectionReader& section, const std::string& key, double* bound) {
  const TomlNode* node = section.Take(key);
  if (node == nullptr) return;
  if (!node->is_number() || std::isnan(node->AsDouble()))
    throw section.Error(key, node->Shown(), "a number, inf or -inf");
  *bound = node->AsDouble();
}

model::ParameterInfo ReadParameter(SectionReader section, const std::string& name) {
  model::ParameterInfo info;
  info.name = name;
  info.unit = "1";
  ReadLine(section, "unit", &info.unit);
  ReadLine(section, "meaning", &info.meaning);
  section.Require("meaning", "a line that says what it is");
  ReadBound(section, "min", &info.min);
  ReadBound(section, "max", &info.max);
  if (!(info.min < info.max)) {
    throw section.Error(section.Has("max") ? "max" : "min",
                        ShortestNumber(section.Has("max") ? info.max : info.min),
                        "a min (0 where none is given, -inf for none) below max");
  }
  section.Boolean("min_allowed", &info.min_allowed);
  section.Number("example", &info.example);
  section.Integer("arm", &info.arm, -9, 9);
  section.Choice("scale", Scales(), &info.scale);
  section.Choice("role", Roles(), &info.role);
  ReadStarts(section, &info);
  info.names = Texts(section, "names", "a list of names");
  std::vector<std::pair<std::string, double model::Parameters::*>> base;
  for (const model::BaseParameter& one : model::BaseParameters())
    base.emplace_back(one.info.name, one.member);
  section.Choice("adds_to", base, &info.adds_to);
  section.Finish();
  return info;
}

model::StateText ReadState(SectionReader section, const std::string& name) {
  model::StateText state;
  state.name = name;
  state.unit = "1";
  ReadLine(section, "unit", &state.unit);
  section.Text("rate", &state.rate);
  section.Require("rate", "a formula for its rate per second");
  section.Text("start", &state.start);
  if (const TomlNode* node = section.Take("scale")) {
    static const std::vector<std::string> names = {"pressure", "flow",  "torque", "arm",
                                                   "angle",    "speed", "voltage"};
    const bool named =
        node->is(TomlNode::Kind::kString) && std::find(names.begin(), names.end(), node->text) != names.end();
    if (!named && !(node->is_number() && kPositive.Holds(node->AsDouble()))) {
      throw section.Error("scale", node->Shown(), QuotedList(names) + ", or a number above 0");
    }
    state.scale = named ? node->text : NumberText(node->AsDouble());
  }
  section.Choice(
      "is",
      {std::pair("p_3", std::string("p_3")), std::pair("actuator_angle", std::string("actuator_angle"))},
      &state.is);
  if (state.is == "actuator_angle" && !section.Has("scale")) state.scale = "arm";
  section.Finish();
  return state;
}

model::SwitchText ReadSwitch(SectionReader section, const std::string& name) {
  model::SwitchText one;
  one.name = name;
  section.Text("margin", &one.margin);
  section.Require("margin", "a formula that falls through 0 where the switch must change");
  section.Text("next", &one.next);
  section.Require("next", "a formula for its next position");
  section.Text("start", &one.start);
  one.sets = Texts(section, "sets", kStatements);
  section.Finish();
  return one;
}

model::EffectText ReadText(SectionReader& section, const TomlNode& table) {
  model::EffectText text;
  text.equation = Texts(section, "equation", kStatements);
  SectionReader equations = section.Section("equations");
  for (const auto& [key, hook] : model::EquationKeys()) {
    std::vector<std::string> statements = Texts(equations, key, kStatements);
    if (!statements.empty()) text.equations.emplace_back(hook, std::move(statements));
  }
  equations.Finish();
  SectionReader where = section.Section("where");
  for (const std::string& name : Keys(table, "where")) {
    std::string formula;
    where.Text(name, &formula);
    text.where.emplace_back(name, formula);
  }
  where.Finish();
  SectionReader states = section.Section("states");
  for (const std::string& name : Keys(table, "states"))
    text.states.push_back(ReadState(states.Section(name), name));
  states.Finish();
  SectionReader switches = section.Section("switches");
  for (const std::string& name : Keys(table, "switches")) {
    text.switches.push_back(ReadSwitch(switches.Section(name), name));
  }
  switches.Finish();
  SectionReader power = section.Section("power");
  power.Text("stored", &text.stored);
  power.Text("dissipated", &text.dissipated);
  power.Text("viscous", &text.viscous);
  power.Finish();
  section.Text("fixed_volume", &text.fixed_volume);
  section.Boolean("replaces_valves", &text.replaces_valves);
  return text;
}

bool IsId(const std::string& id) {
  const size_t dot = id.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == id.size() ||
      id.find('.', dot + 1) != std::string::npos)
    return false;
  return std::all_of(id.begin(), id.end(), [](char c) {
    return std::islower(static_cast<unsigned char>(c)) != 0 ||
           std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  });
}

std::string JoinedEquation(const model::EffectText& text) {
  std::string joined;
  const auto add = [&](const std::string& statement) { joined += (joined.empty() ? "" : "; ") + statement; };
  for (const std::string& statement : text.equation) add(statement);
  for (const auto& [hook, statements] : text.equations) {
    for (const std::string& statement : statements) add(statement);
  }
  for (const model::StateText& state : text.states) add(state.name + "' = " + state.rate);
  return joined;
}

const TomlNode& Nearest(const TomlNode& table, const std::string& dotted) {
  const TomlNode* node = &table;
  size_t begin = 0;
  while (begin <= dotted.size()) {
    const size_t end = std::min(dotted.find('.', begin), dotted.size());
    const TomlNode* inner =
        node->is(TomlNode::Kind::kTable) ? node->Find(dotted.substr(begin, end - begin)) : nullptr;
    if (inner == nullptr) break;
    node = inner;
    begin = end + 1;
  }
  return *node;
}

TomlNode TextsNode(const std::vector<std::string>& texts) {
  std::vector<TomlNode> items;
  items.reserve(texts.size());
  for (const std::string& text : texts) items.push_back(StringNode(text));
  return ArrayNode(std::move(items));
}

TomlNode TruthNode(bool value) {
  TomlNode node;
  node.kind = TomlNode::Kind::kBoolean;
  node.boolean = value;
  return node;
}

void AddText(TomlNode* table, const std::string& key, const std::string& text) {
  if (!text.empty()) table->members.push_back({key, StringNode(text)});
}

void AddTable(TomlNode* table, const std::string& key, TomlNode inner) {
  if (!inner.members.empty()) table->members.push_back({key, std::move(inner)});
}

TomlNode ParameterNode(const model::ParameterInfo& info) {
  const model::ParameterInfo plain;
  TomlNode node;
  const auto add = [&](const char* key, TomlNode value) { node.members.push_back({key, std::move(value)}); };
  add("unit", StringNode(info.unit));
  add("meaning", StringNode(info.meaning));
  if (!info.names.empty()) add("names", TextsNode(info.names));
  if (info.min != plain.min) add("min", NumberNode(info.min));
  if (info.max != plain.max) add("max", NumberNode(info.max));
  if (!info.min_allowed) add("min_allowed", TruthNode(false));
  if (info.starts != plain.starts) {
    std::vector<TomlNode> starts;
    starts.reserve(info.starts.size());
    for (const double start : info.starts) starts.push_back(NumberNode(start));
    add("starts", ArrayNode(std::move(starts)));
  }
  if (info.scale != plain.scale) add("scale", StringNode(NameOf(Scales(), info.scale)));
  if (info.role != plain.role) add("role", StringNode(NameOf(Roles(), info.role)));
  if (info.arm != plain.arm) {
    TomlNode power;
    power.kind = TomlNode::Kind::kInteger;
    power.integer = info.arm;
    add("arm", std::move(power));
  }
  for (const model::BaseParameter& base : model::BaseParameters()) {
    if (info.adds_to != nullptr && info.adds_to == base.member) add("adds_to", StringNode(base.info.name));
  }
  if (info.example != plain.example) add("example", NumberNode(info.example));
  return node;
}

TomlNode StateNode(const model::StateText& state) {
  TomlNode node;
  node.members.push_back({"unit", StringNode(state.unit)});
  node.members.push_back({"rate", StringNode(state.rate)});
  AddText(&node, "start", state.start);
  const std::optional<double> number = ParseNumber(state.scale);
  node.members.push_back({"scale", number.has_value() ? NumberNode(*number) : StringNode(state.scale)});
  AddText(&node, "is", state.is);
  return node;
}

TomlNode SwitchNode(const model::SwitchText& one) {
  TomlNode node;
  node.members.push_back({"margin", StringNode(one.margin)});
  node.members.push_back({"next", StringNode(one.next)});
  AddText(&node, "start", one.start);
  if (!one.sets.empty()) node.members.push_back({"sets", TextsNode(one.sets)});
  return node;
}

}  // namespace

std::shared_ptr<const model::EffectFormulas> ReadFormulas(const TomlNode& table, const std::string& path,
                                                          const std::string& id) {
  SectionReader section(table, path);
  model::EffectInfo info;
  info.id = id;
  section.Text("id", &info.id);
  if (id.empty()) section.Require("id", "the effect's id, as \"arm.spring\"");
  ReadLine(section, "summary", &info.summary);
  section.Require("summary", "a line that says what the effect is; reports print it");
  ReadLine(section, "confused_with", &info.confused_with);
  section.Boolean("remembers_flow", &info.remembers_flow);
  SectionReader parameters = section.Section("parameters");
  for (const std::string& name : Keys(table, "parameters")) {
    // The values stand beside the definition in a model, and one key cannot be both.
    if (name == kDefinition)
      throw parameters.Error(
          name, "it as the name of a parameter",
          "another name: in a model's file, the effect's section has its definition there");
    info.parameters.push_back(ReadParameter(parameters.Section(name), name));
  }
  parameters.Finish();
  model::EffectText text = ReadText(section, table);
  section.Finish();
  if (!id.empty() && info.id != id)
    throw section.Error("id", Quoted(info.id), Quoted(id) + ", as in the model's section");
  if (!IsId(info.id))
    throw section.Error("id", Quoted(info.id), "two names of a-z, 0-9 and _ with a dot: \"arm.spring\"");
  if (model::IsBuiltIn(info.id)) {
    throw section.Error("id", Quoted(info.id) + ", a built-in effect", "another id");
  }
  if (info.id.starts_with(kOfClosures)) {
    throw section.Error("id", Quoted(info.id),
                        std::string("an id that does not begin with ") + kOfClosures +
                            ", because those are the program's own");
  }
  info.equation = JoinedEquation(text);
  if (info.equation.empty()) throw section.Error("equation", "nothing", kStatements);
  try {
    auto formulas = std::make_shared<const model::EffectFormulas>(std::move(info), std::move(text));
    const std::string fault = model::FaultIn(model::EntryOf(formulas));
    if (!fault.empty())
      throw InputError(table.place + ": effect " + Quoted(formulas->info().id) + " " + fault);
    return formulas;
  } catch (const model::EffectTextError& error) {
    throw InputError(Nearest(table, error.key()).place + ": " + (path.empty() ? "" : path + ".") +
                     error.key() + ": " + error.what());
  }
}

std::shared_ptr<const model::EffectFormulas> LoadEffectFile(const std::string& file) {
  TomlNode root = ParseToml(ReadTextFile(file), file);
  root.place = file;
  return ReadFormulas(root, "", "");
}

TomlNode FormulasNode(const model::EffectFormulas& formulas) {
  const model::EffectInfo& info = formulas.info();
  const model::EffectText& text = formulas.text();
  TomlNode node;
  node.members.push_back({"summary", StringNode(info.summary)});
  AddText(&node, "confused_with", info.confused_with);
  if (info.remembers_flow) node.members.push_back({"remembers_flow", TruthNode(true)});
  if (text.replaces_valves) node.members.push_back({"replaces_valves", TruthNode(true)});
  if (!text.equation.empty()) node.members.push_back({"equation", TextsNode(text.equation)});
  AddText(&node, "fixed_volume", text.fixed_volume);
  TomlNode equations, where, parameters, states, switches, power;
  for (const auto& [hook, statements] : text.equations) {
    equations.members.push_back({NameOf(model::EquationKeys(), hook), TextsNode(statements)});
  }
  for (const auto& [name, formula] : text.where) where.members.push_back({name, StringNode(formula)});
  for (const model::ParameterInfo& one : info.parameters)
    parameters.members.push_back({one.name, ParameterNode(one)});
  for (const model::StateText& one : text.states) states.members.push_back({one.name, StateNode(one)});
  for (const model::SwitchText& one : text.switches) switches.members.push_back({one.name, SwitchNode(one)});
  AddText(&power, "stored", text.stored);
  AddText(&power, "dissipated", text.dissipated);
  AddText(&power, "viscous", text.viscous);
  AddTable(&node, "equations", std::move(equations));
  AddTable(&node, "where", std::move(where));
  AddTable(&node, "parameters", std::move(parameters));
  AddTable(&node, "states", std::move(states));
  AddTable(&node, "switches", std::move(switches));
  AddTable(&node, "power", std::move(power));
  return node;
}

bool IncludeDefinitions(TomlNode* model, const std::string& model_file) {
  TomlNode* effects = model->Find("effects");
  if (effects == nullptr || !effects->is(TomlNode::Kind::kTable)) return false;
  bool included = false;
  for (TomlMember& effect : effects->members) {
    TomlNode* definition =
        effect.second.is(TomlNode::Kind::kTable) ? effect.second.Find("definition") : nullptr;
    if (definition == nullptr || !definition->is(TomlNode::Kind::kString)) continue;
    const std::string place = definition->place;
    const std::string file = PathBeside(model_file, definition->text);
    try {
      TomlNode table = ParseToml(ReadTextFile(file), file);
      table.place = file;
      *definition = std::move(table);
    } catch (const InputError& error) {
      throw InputError(place + ": effects." + effect.first + ".definition: " + error.what());
    }
    included = true;
  }
  return included;
}

}  // namespace hydro::settings
