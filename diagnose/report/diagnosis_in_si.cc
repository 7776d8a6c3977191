#include "diagnose/report/diagnosis_in_si.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "base/units.h"
#include "diagnose/closure/resemblance.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {
namespace {

double Largest(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

void Scale(double factor, std::vector<double>* values) {
  for (double& value : *values) value *= factor;
}

// Returns the factor.
double Convert(Estimated* estimated) {
  const std::optional<SiUnit> unit = FindSiUnit(estimated->unit, estimated->value);
  if (!unit.has_value()) return 1;
  estimated->value *= unit->factor;
  estimated->low *= unit->factor;
  estimated->high *= unit->factor;
  estimated->unit = unit->to;
  return unit->factor;
}

// All runs by one unit, that of the largest value.
void Convert(ValueByRun* value) {
  std::vector<double> values;
  for (const Estimated& run : value->values) values.push_back(run.value);
  const std::optional<SiUnit> unit = FindSiUnit(value->unit, Largest(values));
  if (!unit.has_value()) return;
  for (Estimated& run : value->values) {
    run.value *= unit->factor;
    run.low *= unit->factor;
    run.high *= unit->factor;
    run.unit = unit->to;
  }
  value->unit = unit->to;
}

// Returns the factors of the variable and of the term.
std::pair<double, double> Convert(MissingTerm* term) {
  std::pair<double, double> factors = {1, 1};
  if (const std::optional<SiUnit> unit = FindSiUnit(term->unit, Largest(term->mean))) {
    Scale(unit->factor, &term->mean);
    Scale(unit->factor, &term->error);
    term->unit = unit->to;
    factors.second = unit->factor;
  }
  if (const std::optional<SiUnit> unit = FindSiUnit(term->against_unit, Largest(term->at))) {
    Scale(unit->factor, &term->at);
    term->against_unit = unit->to;
    factors.first = unit->factor;
  }
  return factors;
}

void Convert(Closure* closure) {
  if (const std::optional<SiUnit> unit = FindSiUnit(closure->unit, Largest(closure->value))) {
    for (std::vector<double>* values : {&closure->value, &closure->low, &closure->high})
      Scale(unit->factor, values);
    closure->unit = unit->to;
  }
  for (size_t i = 0; i < closure->knots.size(); ++i) {
    const std::optional<SiUnit> unit = FindSiUnit(closure->against_units[i], Largest(closure->knots[i]));
    if (!unit.has_value()) continue;
    Scale(unit->factor, &closure->knots[i]);
    closure->against_units[i] = unit->to;
  }
  closure->resembles = Resemblance(*closure);  // it may say a place
}

void Replace(const std::string& what, const std::string& with, std::string* text) {
  for (size_t at = text->find(what); at != std::string::npos; at = text->find(what, at + with.size()))
    text->replace(at, what.size(), with);
}

// The words of a text; ids such as pump.stribeck have no article.
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
  // There is nothing that could leak.
  std::erase_if(diagnosis->remarks, [](const std::string& remark) {
    return remark.starts_with("leakage and valves cannot be judged");
  });
  for (std::string& remark : diagnosis->remarks) SpeakOfTheMotor(&remark);
}

void ShowTheMotorAlone(Diagnosis* diagnosis) {
  const auto name = [](std::string* balance) {
    if (*balance == "pump_torque") *balance = "motor torque";
  };
  for (Location& location : diagnosis->location) name(&location.balance);
  for (MissingTerm& term : diagnosis->missing) name(&term.balance);
  for (FoundTerm& term : diagnosis->terms) name(&term.missing.balance);
  std::erase_if(diagnosis->candidates, [](const Candidate& candidate) {
    constexpr const char* kOfTheOil[] = {"accumulator.",
                                         "actuator.",
                                         "arm.",
                                         "closure.flow",
                                         "closure.arm",
                                         "fluid.",
                                         "line.",
                                         "pump.flow_ripple",
                                         "pump.pressure_friction",
                                         "pump.turbulent_leakage",
                                         "sensor.pressure",
                                         "valve.",
                                         "parameter beta",
                                         "parameter V_ms",
                                         "parameter c",
                                         "parameter c_E",
                                         "parameter c_I",
                                         "parameter p_3",
                                         "parameter k_2",
                                         "parameter J_a",
                                         "parameter mgl",
                                         "parameter D"};
    const bool tried = std::isfinite(candidate.held_out) || candidate.weight > 0;
    return !tried && std::any_of(std::begin(kOfTheOil), std::end(kOfTheOil),
                                 [&](const char* begin) { return candidate.id.starts_with(begin); });
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
  for (ValueByRun& value : diagnosis.per_run) Convert(&value);
  for (MissingTerm& term : diagnosis.missing) Convert(&term);
  for (FoundTerm& term : diagnosis.terms) {
    const std::pair<double, double> factors = Convert(&term.missing);
    Scale(factors.first, &term.at);
    Scale(factors.second, &term.value);
  }
  return diagnosis;
}

}  // namespace hydro::diagnose
