#include "diagnose/report/diagnosis_in_si.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

#include "base/number_text.h"
#include "base/units.h"
#include "diagnose/fit/closure.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {
namespace {

// Converts all lists to one unit, which suits the largest value of the first list, and names it.
void Convert(std::string* unit, const std::vector<std::vector<double>*>& lists) {
  double largest = 0;
  for (const double value : *lists.front()) largest = std::fmax(largest, std::abs(value));
  const std::optional<SiUnit> to = FindSiUnit(*unit, largest);
  if (!to.has_value()) return;
  for (std::vector<double>* values : lists) {
    for (double& value : *values) value *= to->factor;
  }
  *unit = to->to;
}

// The same for values with intervals; returns the factor.
double Convert(std::vector<Estimated>* estimated, std::string* unit) {
  double largest = 0;
  for (const Estimated& one : *estimated) largest = std::fmax(largest, std::abs(one.value));
  const std::optional<SiUnit> to = FindSiUnit(*unit, largest);
  if (!to.has_value()) return 1;
  for (Estimated& one : *estimated) {
    for (double* value : {&one.value, &one.low, &one.high}) *value *= to->factor;
    one.unit = to->to;
  }
  *unit = to->to;
  return to->factor;
}

double Convert(Estimated* estimated) {
  std::vector<Estimated> one = {*estimated};
  std::string unit = estimated->unit;
  const double factor = Convert(&one, &unit);
  *estimated = one.front();
  return factor;
}

void Convert(MeasuredCurve* curve) {
  Convert(&curve->unit, {&curve->measured, &curve->error, &curve->model, &curve->found});
  Convert(&curve->against_unit, {&curve->at});
}

void Convert(Closure* closure) {
  Convert(&closure->unit, {&closure->value, &closure->low, &closure->high});
  for (size_t i = 0; i < closure->knots.size(); ++i)
    Convert(&closure->against_units[i], {&closure->knots[i]});
  closure->resembles = Resemblance(*closure);  // its text may contain a value
}

// The numbers with a unit of a text such as "p2 - p1 from 100 to 300 psi".
std::string NumbersInSi(const std::string& text) {
  static const std::string kNumber = "[+-]?[0-9]+(?:[.][0-9]+)?(?:e[+-]?[0-9]+)?";
  static const std::regex kWithUnit("(^|[^\\w.])(?:(" + kNumber + ")( to ))?(" + kNumber +
                                    ") ([A-Za-z][A-Za-z0-9^/().-]*)");
  std::string converted;
  auto rest = text.begin();
  for (std::sregex_iterator found(text.begin(), text.end(), kWithUnit), end; found != end; ++found) {
    const std::smatch& parts = *found;
    const double value = std::stod(parts[4]), low = parts[2].matched ? std::stod(parts[2]) : value;
    const std::optional<SiUnit> to = FindSiUnit(parts[5], std::max(std::abs(value), std::abs(low)));
    if (!to.has_value()) continue;
    const auto shown = [&](const std::ssub_match& number) {
      return (*number.first == '+' ? "+" : "") + ShortNumber(std::stod(number) * to->factor, 3);
    };
    converted.append(rest, parts[1].second);
    if (parts[2].matched) converted += shown(parts[2]) + parts[3].str();
    converted += shown(parts[4]) + " " + to->to;
    rest = parts[0].second;
  }
  return converted.append(rest, text.end());
}

void Replace(const std::string& what, const std::string& with, std::string* text) {
  for (size_t at = text->find(what); at != std::string::npos; at = text->find(what, at + with.size()))
    text->replace(at, what.size(), with);
}

// Whether an effect or a parameter does not exist in a motor alone.
bool IsOfTheOil(const std::string& id) {
  static const std::regex oil(
      "((accumulator|actuator|arm|fluid|line|valve)[.]|closure[.](flow|arm|cross|outer)|"
      "pump[.](flow_ripple|pressure_friction|turbulent_leakage)|sensor[.]pressure|"
      "parameter (beta|V_ms|c|c_E|c_I|p_3|k_2|J_a|mgl|D)( |$)).*");
  return std::regex_match(id, oil);
}

// Changes the words of a text. Ids such as pump.stribeck have no article.
void SpeakOfTheMotor(std::string* text) {
  Replace("the pump's", "the motor's or its gear's", text);
  Replace("the pump", "the motor or its gear", text);
  Replace("The pump", "The motor or its gear", text);
}

}  // namespace

void SpeakOfTheMotor(Diagnosis* diagnosis) {
  SpeakOfTheMotor(&diagnosis->sentence);
  SpeakOfTheMotor(&diagnosis->next.why);
  for (FoundEffect& effect : diagnosis->effects) SpeakOfTheMotor(&effect.summary);
  for (Candidate& candidate : diagnosis->candidates) SpeakOfTheMotor(&candidate.rejected_because);
  // A motor alone has nothing that could leak.
  std::erase_if(diagnosis->remarks, [](const std::string& remark) {
    return remark.starts_with("leakage and valves cannot be judged") || IsOfTheOil(remark);
  });
  for (std::string& remark : diagnosis->remarks) SpeakOfTheMotor(&remark);
}

void ShowTheMotorAlone(Diagnosis* diagnosis) {
  const auto name = [](std::string* balance) {
    if (*balance == "pump_torque") *balance = "motor torque";
    if (*balance == "pump_friction") *balance = "friction";
  };
  const auto closures = [](std::string* id) { Replace("closure.pump_torque", "closure.motor_torque", id); };
  for (Location& location : diagnosis->location) name(&location.balance);
  for (WeightedSet& one : diagnosis->explanations)
    std::ranges::for_each(one.changes, [&](std::string& change) { closures(&change); });
  for (Closure& closure : diagnosis->closures) closures(&closure.id);
  for (Candidate& candidate : diagnosis->candidates) closures(&candidate.id);
  for (ChoiceWithout& choice : diagnosis->choices) closures(&choice.chosen);
  for (std::vector<MeasuredCurve>* curves : {&diagnosis->missing, &diagnosis->terms, &diagnosis->measured}) {
    for (MeasuredCurve& curve : *curves) name(&curve.balance), name(&curve.element);
  }
  std::erase_if(diagnosis->candidates, [](const Candidate& candidate) {
    const bool tried = std::isfinite(candidate.held_out) || candidate.weight > 0;
    return !tried && IsOfTheOil(candidate.id);
  });
}

ShownUnit UnitOf(model::Channel channel, const UnitSystem& units, bool si) {
  const std::string own = ChannelUnit(channel, units);
  const std::optional<SiUnit> unit = si ? FindSiUnit(own, 0) : std::nullopt;
  if (!unit.has_value()) return {own, 1};
  return {unit->to, unit->factor};
}

Diagnosis InSi(Diagnosis diagnosis) {
  for (FoundEffect& effect : diagnosis.effects) {
    for (Estimated& parameter : effect.parameters) Convert(&parameter);
  }
  for (Closure& closure : diagnosis.closures) Convert(&closure);
  for (ChangedParameter& parameter : diagnosis.parameters) parameter.model *= Convert(&parameter.fitted);
  for (ValueByRun& value : diagnosis.per_run) Convert(&value.values, &value.unit);
  for (std::vector<MeasuredCurve>* curves : {&diagnosis.missing, &diagnosis.terms, &diagnosis.measured}) {
    for (MeasuredCurve& curve : *curves) Convert(&curve);
  }
  for (Location& location : diagnosis.location) location.where = NumbersInSi(location.where);
  return diagnosis;
}

}  // namespace hydro::diagnose
