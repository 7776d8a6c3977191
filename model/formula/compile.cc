#include "model/formula/compile.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "base/word_list.h"
#include "model/terms/state.h"

namespace hydro::model {
namespace {

constexpr char kBasePrefix[] = "base_";

const std::vector<std::string>& BaseNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const BaseParameter& parameter : BaseParameters()) all.push_back(parameter.info.name);
    return all;
  }();
  return names;
}

// A parameter of the paper under its own name or as base_NAME. An effect may change D, b and others: the
// plain name is the current value, and base_D is the value in the model's file.
std::optional<size_t> BasePlaceOf(const std::string& name) {
  if (name.starts_with(kBasePrefix)) return PlaceOf(BaseNames(), name.substr(sizeof(kBasePrefix) - 1));
  return PlaceOf(BaseNames(), name);
}

// The place of `name` among the effect's parameters that are numbers, or that are names.
std::optional<size_t> OwnPlace(const EffectInfo& info, const std::string& name, bool number) {
  size_t place = 0;
  for (const ParameterInfo& parameter : info.parameters) {
    if (parameter.is_number() != number) continue;
    if (parameter.name == name) return place;
    ++place;
  }
  return std::nullopt;
}

template <class Named>
std::optional<size_t> PlaceIn(const std::vector<Named>& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& one) { return one.name == name; });
  if (found == list.end()) return std::nullopt;
  return static_cast<size_t>(found - list.begin());
}

bool ReadsSensors(Hook hook) { return hook == Hook::kTransducers || hook == Hook::kReadings; }

// Comparisons become switches at those hooks that are evaluated repeatedly between events.
bool IsLocated(Hook hook) { return hook >= Hook::kProperties && hook <= Hook::kBalances; }

constexpr char kBuiltIn[] = "dp";  // p2 - p1

// "transducer_p1" is the reading of p1 before the effects on readings.
std::optional<size_t> ReadingPlace(const std::string& name, Hook hook) {
  if (hook == Hook::kTransducers && name.starts_with("transducer_p")) {
    return PlaceOf(ReadingNames(), "measured" + name.substr(std::string("transducer").size()));
  }
  return ReadsSensors(hook) ? PlaceOf(ReadingNames(), name) : std::nullopt;
}

const char* HookText(Hook hook) {
  static constexpr const char* kTexts[] = {"where volumes are checked",
                                           "among the properties",
                                           "among torques and flows",
                                           "among the states",
                                           "in the balances",
                                           "in switches",
                                           "at the start",
                                           "in transducers",
                                           "in readings"};
  return kTexts[static_cast<size_t>(hook)];
}

}  // namespace

const std::vector<std::pair<std::string, Hook>>& EquationKeys() {
  static const std::vector<std::pair<std::string, Hook>> keys = {
      {"properties", Hook::kProperties},   {"torques_and_flows", Hook::kTorquesAndFlows},
      {"states", Hook::kStates},           {"balances", Hook::kBalances},
      {"transducers", Hook::kTransducers}, {"readings", Hook::kReadings}};
  return keys;
}

FormulaCompiler::FormulaCompiler(const EffectInfo& info, const EffectText& text) : info_(info), text_(text) {
  for (const ParameterInfo& parameter : info.parameters)
    CheckNewName("parameters." + parameter.name, parameter.name);
  for (const StateText& state : text.states) CheckNewName("states." + state.name, state.name);
  for (const SwitchText& one : text.switches) CheckNewName("switches." + one.name, one.name);
  AddWhere();
  const auto note = [&](const std::vector<std::string>& statements) {
    for (const std::string& statement : statements) {
      try {
        const std::optional<size_t> place = FieldPlace(FullName(ParseStatement(statement).target));
        if (place.has_value() && *place >= kFirstScratch && *place < kFirstFixed)
          scratch_.insert(FieldNames()[*place].name);
      } catch (const FormulaError&) {  // reported where the statement is compiled
      }
    }
  };
  note(text.equation);
  for (const auto& [hook, statements] : text.equations) note(statements);
}

void FormulaCompiler::AddWhere() {
  where_[kBuiltIn] = ParseExpression("p2 - p1");
  for (const auto& [name, formula] : text_.where) {
    CheckNewName("where." + name, name);
    try {
      where_[name] = ParseExpression(formula);
    } catch (const FormulaError& error) {
      throw EffectTextError("where." + name, std::string(error.what()) + " of " + ShortQuote(formula));
    }
  }
}

void FormulaCompiler::CheckNewName(const std::string& key, const std::string& name) const {
  const std::string full = FullName(name);
  const bool taken = full != name || FieldPlace(name) || BasePlaceOf(name) || PlaceOf(FactNames(), name) ||
                     PlaceOf(StartNames(), name) || PlaceOf(ReadingNames(), name) ||
                     PlaceOf(FunctionNames(), name) || name == "t" || name == "pi" || name == kBuiltIn;
  if (taken)
    throw EffectTextError(
        key, "found " + ShortQuote(name) + ", which the model has already, allowed another name");
  const size_t count = (OwnPlace(info_, name, true) ? 1 : 0) + (OwnPlace(info_, name, false) ? 1 : 0) +
                       (PlaceIn(text_.states, name) ? 1 : 0) + (PlaceIn(text_.switches, name) ? 1 : 0) +
                       static_cast<size_t>(std::count_if(text_.where.begin(), text_.where.end(),
                                                         [&](const auto& one) { return one.first == name; }));
  if (count > 1)
    throw EffectTextError(key, "found " + ShortQuote(name) + " twice, allowed one meaning for a name");
  try {
    if (ParseExpression(name).operation == Operation::kName && name.back() != '\'') return;
  } catch (const FormulaError&) {  // reported below
  }
  throw EffectTextError(
      key, "found the name " + ShortQuote(name) + ", allowed letters, digits and _, a letter first");
}

NameMeaning FormulaCompiler::FieldMeaning(const std::string& name, size_t place, size_t column,
                                          Hook hook) const {
  const FieldName& field = FieldNames()[place];
  if (place >= kFirstScratch && place < kFirstFixed && !scratch_.contains(name)) {
    throw FormulaError(column, '"' + name + "\", which this effect does not set",
                       "it after \"" + name + " = ...\"");
  }
  if (field.known > hook) {
    throw FormulaError(column, '"' + name + "\", which is not known yet " + HookText(hook),
                       std::string("it from there on where it is: ") + HookText(field.known) +
                           "; [equations] says where a statement acts");
  }
  return {.source = Source::kField, .place = place, .number = 0, .formula = nullptr, .fixed = false};
}

NameMeaning FormulaCompiler::MeaningOf(const std::string& given, size_t column, Hook hook) const {
  const std::string name = FullName(given);
  const auto found = where_.find(name);
  if (found != where_.end())
    return {.source = Source::kConstant, .place = 0, .number = 0, .formula = &found->second};
  const auto meaning = [](Source source, size_t place, bool fixed) {
    return NameMeaning{.source = source, .place = place, .number = 0, .formula = nullptr, .fixed = fixed};
  };
  if (name == "pi")
    return {.source = Source::kConstant,
            .place = 0,
            .number = std::numbers::pi,
            .formula = nullptr,
            .fixed = true};
  if (const auto place = OwnPlace(info_, name, true)) return meaning(Source::kOwn, *place, true);
  if (hook != Hook::kFixedVolume) {
    if (name == "t") return meaning(Source::kTime, 0, false);
    if (const auto place = PlaceIn(text_.states, name)) return meaning(Source::kOwnState, *place, false);
  }
  if (ReadsSensors(hook)) {
    if (const auto place = ReadingPlace(name, hook)) return meaning(Source::kReading, *place, false);
    static const std::vector<std::pair<std::string, size_t>> states = {
        {"motor_angle", kMotorAngle}, {"motor_speed", kMotorSpeed}, {"p1", kP1}, {"p2", kP2}};
    for (const auto& [state, place] : states) {
      if (state == name) return meaning(Source::kBaseState, place, false);
    }
  } else if (hook != Hook::kFixedVolume) {
    if (const auto place = FieldPlace(name)) return FieldMeaning(name, *place, column, hook);
    if (const auto place = PlaceIn(text_.switches, name)) return meaning(Source::kSwitch, *place, true);
    if (const auto place = PlaceOf(FactNames(), name)) {
      return meaning(Source::kFact, *place, static_cast<Fact>(*place) != Fact::kTemperature);
    }
  }
  if (!ReadsSensors(hook)) {
    if (const auto place = BasePlaceOf(name)) return meaning(Source::kBase, *place, true);
  }
  if (hook == Hook::kStart) {
    if (const auto place = PlaceOf(StartNames(), name)) return meaning(Source::kAtStart, *place, false);
  }
  if (hook == Hook::kSwitches && name.ends_with('\'')) {
    const auto place = PlaceIn(text_.states, name.substr(0, name.size() - 1));
    if (place.has_value()) return meaning(Source::kOwnRate, *place, false);
  }
  throw FormulaError(column, "the unknown name " + ShortQuote(given),
                     std::string("the effect's own names, and those of the model that are known ") +
                         HookText(hook) + DidYouMean(given, NamesAt(hook)));
}

std::vector<std::string> FormulaCompiler::NamesAt(Hook hook) const {
  std::vector<std::string> names = {"t", "pi"};
  for (const auto& [name, formula] : where_) names.push_back(name);
  for (const ParameterInfo& parameter : info_.parameters) names.push_back(parameter.name);
  for (const StateText& state : text_.states) names.push_back(state.name);
  for (const SwitchText& one : text_.switches) names.push_back(one.name);
  if (ReadsSensors(hook)) {
    names.insert(names.end(), ReadingNames().begin(), ReadingNames().end());
    return names;
  }
  names.insert(names.end(), BaseNames().begin(), BaseNames().end());
  if (hook == Hook::kFixedVolume) return names;
  names.insert(names.end(), FactNames().begin(), FactNames().end());
  for (const FieldName& field : FieldNames()) {
    if (field.known <= hook) names.emplace_back(field.name);
  }
  return names;
}

bool FormulaCompiler::IsFixed(const Expression& expression, Context& context) const {
  if (expression.operation == Operation::kName) {
    if (OwnPlace(info_, expression.name, false)) return true;
    const NameMeaning meaning = MeaningOf(expression.name, expression.column, context.hook);
    if (meaning.formula == nullptr) return meaning.fixed;
    // Names may stand for each other many times over, so each is examined once.
    if (const auto asked = context.fixed.find(expression.name); asked != context.fixed.end())
      return asked->second;
    if (!context.within.insert(expression.name).second) return false;  // reported where it is emitted
    const bool fixed = IsFixed(*meaning.formula, context);
    context.within.erase(expression.name);
    context.fixed[expression.name] = fixed;
    return fixed;
  }
  return std::all_of(expression.operands.begin(), expression.operands.end(),
                     [&](const Expression& operand) { return IsFixed(operand, context); });
}

uint16_t FormulaCompiler::Push(const Instruction& instruction, size_t column, Context& context) {
  if (context.program->size() >= kLargestProgram) {
    throw FormulaError(column, "more than " + std::to_string(kLargestProgram) + " operations",
                       "fewer at one place of the equations");
  }
  context.program->push_back(instruction);
  return static_cast<uint16_t>(context.program->size() - 1);
}

void FormulaCompiler::PushStore(uint16_t value, Source to, size_t place, Context& context) {
  Push({.kind = Instruction::Kind::kStore, .source = to, .a = value, .b = static_cast<uint16_t>(place)}, 1,
       context);
  context.known.clear();
}

uint16_t FormulaCompiler::Emit(const Expression& expression, Context& context) {
  const std::string text = Written(expression);
  const auto known = context.known.find(text);
  if (known != context.known.end()) return known->second;
  uint16_t place = 0;
  if (expression.operation == Operation::kNumber) {
    place =
        Push({.kind = Instruction::Kind::kLoad, .constant = expression.number}, expression.column, context);
  } else if (expression.operation == Operation::kName) {
    place = EmitName(expression, context);
  } else if (expression.operation == Operation::kText) {
    throw FormulaError(expression.column, "the text " + ShortQuote(expression.name),
                       "one that is compared with a parameter that is a name: signal == \"p1\"");
  } else {
    place = EmitOperation(expression, context);
  }
  context.known[text] = place;
  return place;
}

uint16_t FormulaCompiler::EmitName(const Expression& name, Context& context) {
  if (OwnPlace(info_, name.name, false)) {
    throw FormulaError(name.column, "the name \"" + name.name + "\" as a number",
                       "a comparison with one of its names");
  }
  const NameMeaning meaning = MeaningOf(name.name, name.column, context.hook);
  if (meaning.formula != nullptr) {
    if (!context.within.insert(name.name).second) {
      throw FormulaError(name.column, '"' + name.name + "\", which stands for itself",
                         "definitions without a circle");
    }
    const uint16_t place = Emit(*meaning.formula, context);
    context.within.erase(name.name);
    return place;
  }
  return Push({.kind = Instruction::Kind::kLoad,
               .source = meaning.source,
               .a = static_cast<uint16_t>(meaning.place),
               .constant = meaning.number},
              name.column, context);
}

uint16_t FormulaCompiler::EmitOperation(const Expression& expression, Context& context) {
  const Operation operation = expression.operation;
  const std::vector<Expression>& operands = expression.operands;
  if (operation == Operation::kEqual || operation == Operation::kUnequal) {
    if (operands[0].operation == Operation::kText || operands[1].operation == Operation::kText) {
      return EmitChoice(expression, context);
    }
  }
  if (IsLocated(context.hook) && !IsFixed(expression, context)) {
    if (operation == Operation::kLess || operation == Operation::kAtMost) {
      return EmitComparison(operands[0], operands[1], context);
    }
    if (operation == Operation::kEqual || operation == Operation::kUnequal) {
      throw FormulaError(expression.column, "== of quantities that change", "< or >");
    }
    if (operation == Operation::kSign) {  // 2 (x > 0) - 1
      const uint16_t positive = EmitComparison(Expression{}, operands[0], context);
      const uint16_t twice =
          Push({.operation = Operation::kAdd, .a = positive, .b = positive}, expression.column, context);
      const uint16_t one =
          Push({.kind = Instruction::Kind::kLoad, .constant = 1}, expression.column, context);
      return Push({.operation = Operation::kSubtract, .a = twice, .b = one}, expression.column, context);
    }
  }
  Instruction instruction{.operation = operation};
  if (operation == Operation::kPower && operands[1].operation == Operation::kNumber &&
      operands[1].number == 2) {
    instruction.operation = Operation::kMultiply;
    instruction.a = instruction.b = Emit(operands[0], context);
    return Push(instruction, expression.column, context);
  }
  uint16_t* const to[] = {&instruction.a, &instruction.b, &instruction.c};
  for (size_t i = 0; i < operands.size(); ++i) *to[i] = Emit(operands[i], context);
  return Push(instruction, expression.column, context);
}

uint16_t FormulaCompiler::EmitComparison(const Expression& low, const Expression& high, Context& context) {
  const auto same = [&](const FoundComparison& one) {
    return Written(one.low) == Written(low) && Written(one.high) == Written(high);
  };
  const auto found = std::find_if(comparisons_.begin(), comparisons_.end(), same);
  const auto place = static_cast<size_t>(found - comparisons_.begin());
  if (found == comparisons_.end()) comparisons_.push_back({low, high});
  return Push({.kind = Instruction::Kind::kLoad,
               .source = Source::kSwitch,
               .a = static_cast<uint16_t>(text_.switches.size() + place)},
              high.column, context);
}

uint16_t FormulaCompiler::EmitChoice(const Expression& expression, Context& context) {
  const bool text_first = expression.operands[0].operation == Operation::kText;
  const Expression& text = expression.operands[text_first ? 0 : 1];
  const Expression& name = expression.operands[text_first ? 1 : 0];
  const std::optional<size_t> place =
      name.operation == Operation::kName ? OwnPlace(info_, name.name, false) : std::nullopt;
  if (!place.has_value()) {
    throw FormulaError(text.column, "the text " + ShortQuote(text.name),
                       "it beside a parameter of the effect that is a name");
  }
  const auto parameter = std::find_if(info_.parameters.begin(), info_.parameters.end(),
                                      [&](const ParameterInfo& one) { return one.name == name.name; });
  const std::optional<size_t> choice = PlaceOf(parameter->names, text.name);
  if (!choice.has_value()) {
    throw FormulaError(text.column, "the text " + ShortQuote(text.name),
                       "one of the names of \"" + name.name + '"' + DidYouMean(text.name, parameter->names));
  }
  const uint16_t is = Push({.kind = Instruction::Kind::kLoad,
                            .source = Source::kChoice,
                            .a = static_cast<uint16_t>(*place),
                            .b = static_cast<uint16_t>(*choice)},
                           text.column, context);
  if (expression.operation == Operation::kEqual) return is;
  return Push({.operation = Operation::kNot, .a = is}, text.column, context);
}

Program FormulaCompiler::Value(const std::string& key, const std::string& text, Hook hook) {
  Program program;
  AppendValue(key, text, hook, Source::kResult, 0, &program);
  return program;
}

void FormulaCompiler::AppendValue(const std::string& key, const std::string& text, Hook hook, Source to,
                                  size_t place, Program* program) {
  Context context{.hook = hook, .program = program, .known = {}, .within = {}};
  try {
    PushStore(Emit(ParseExpression(text), context), to, place, context);
  } catch (const FormulaError& error) {
    throw EffectTextError(key, std::string(error.what()) + " of " + ShortQuote(text));
  }
}

void FormulaCompiler::Append(const std::string& key, const std::string& statement, Hook hook,
                             Program* program) {
  Context context{.hook = hook, .program = program, .known = {}, .within = {}};
  try {
    AppendStatement(ParseStatement(statement), context);
  } catch (const FormulaError& error) {
    throw EffectTextError(key, std::string(error.what()) + " of " + ShortQuote(statement));
  }
}

void FormulaCompiler::AppendStatement(const Statement& statement, Context& context) {
  const std::string target = FullName(statement.target);
  Source to = Source::kField;
  size_t place = 0;
  if (const auto reading = ReadingPlace(target, context.hook)) {
    to = Source::kReading;
    place = *reading;
  } else if (const auto field = FieldPlace(target);
             field.has_value() && *field < kFirstFixed && IsLocated(context.hook)) {
    place = *field;
    const FieldName& name = FieldNames()[place];
    if (context.hook < name.known || context.hook > name.last) {
      throw FormulaError(1, "a change of \"" + target + "\" " + HookText(context.hook),
                         std::string("it ") + HookText(name.known));
    }
  } else if (const auto state = PlaceIn(text_.states, target);
             state.has_value() && context.hook == Hook::kSwitches) {
    to = Source::kOwnState;
    place = *state;
  } else if (context.hook == Hook::kSwitches && (target == "arm_speed" || target == "motor_speed")) {
    to = Source::kBaseState;
    place = target == "arm_speed" ? kArmSpeed : kMotorSpeed;
  } else {
    std::vector<std::string> names;
    for (const FieldName& one : FieldNames()) names.emplace_back(one.name);
    names.resize(kFirstFixed);
    throw FormulaError(1, "a change of " + ShortQuote(statement.target),
                       std::string("one of what effects may change ") + HookText(context.hook) +
                           " (docs/effects.md)" + DidYouMean(statement.target, names));
  }
  Expression value = statement.value;
  if (statement.assignment != Assignment::kSet) {
    static constexpr Operation kJoins[] = {Operation::kNumber, Operation::kAdd, Operation::kSubtract,
                                           Operation::kMultiply, Operation::kDivide};
    Expression before;
    before.operation = Operation::kName;
    before.name = statement.target;
    Expression joined;
    joined.operation = kJoins[static_cast<size_t>(statement.assignment)];
    joined.operands = {std::move(before), std::move(value)};
    value = std::move(joined);
  }
  PushStore(Emit(value, context), to, place, context);
}

Hook FormulaCompiler::HookOf(const std::string& key, const std::string& statement) const {
  try {
    const std::string target = FullName(ParseStatement(statement).target);
    if (PlaceOf(ReadingNames(), target)) return Hook::kReadings;
    if (target.starts_with("transducer_p")) return Hook::kTransducers;
    const std::optional<size_t> place = FieldPlace(target);
    return place.has_value() ? FieldNames()[*place].known
                             : Hook::kTorquesAndFlows;  // where an unknown one is reported
  } catch (const FormulaError& error) {
    throw EffectTextError(key, std::string(error.what()) + " of " + ShortQuote(statement));
  }
}

SwitchPrograms FormulaCompiler::ComparisonPrograms(size_t comparison) {
  const FoundComparison found = comparisons_[comparison];
  SwitchPrograms programs;
  Context context{.hook = Hook::kSwitches, .program = &programs.margin, .known = {}, .within = {}};
  const auto is = [&](Context& in) {
    return Push({.kind = Instruction::Kind::kLoad,
                 .source = Source::kSwitch,
                 .a = static_cast<uint16_t>(text_.switches.size() + comparison)},
                1, in);
  };
  const uint16_t high = Emit(found.high, context);
  const uint16_t low = Emit(found.low, context);
  const uint16_t room = Push({.operation = Operation::kSubtract, .a = high, .b = low}, 1, context);
  const uint16_t other = Push({.operation = Operation::kSubtract, .a = low, .b = high}, 1, context);
  const uint16_t position = is(context);
  const uint16_t margin =
      Push({.operation = Operation::kIf, .a = position, .b = room, .c = other}, 1, context);
  PushStore(margin, Source::kResult, 0, context);
  context.program = &programs.next;
  const uint16_t before = is(context);
  const uint16_t after = Push({.operation = Operation::kNot, .a = before}, 1, context);
  PushStore(after, Source::kResult, 0, context);
  return programs;
}

}  // namespace hydro::model
