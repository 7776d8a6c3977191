#include "diagnose/report/diagnosis_in_si.h"

#include <cmath>

#include "base/si_units.h"
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
  const SiUnit* unit = FindSiUnit(estimated->unit, estimated->value);
  if (unit == nullptr) return 1;
  estimated->value *= unit->factor;
  estimated->low *= unit->factor;
  estimated->high *= unit->factor;
  estimated->unit = unit->to;
  return unit->factor;
}

}  // namespace

ShownUnit UnitOf(model::Channel channel, bool si) {
  const SiUnit* unit = si ? FindSiUnit(ChannelUnit(channel), 0) : nullptr;
  if (unit == nullptr) return {ChannelUnit(channel), 1};
  return {unit->to, unit->factor};
}

Diagnosis InSi(Diagnosis diagnosis) {
  for (FoundEffect& effect : diagnosis.effects) {
    for (Estimated& parameter : effect.parameters) Convert(&parameter);
  }
  for (ChangedParameter& parameter : diagnosis.parameters) parameter.model *= Convert(&parameter.fitted);
  for (MissingTerm& term : diagnosis.missing) {
    if (const SiUnit* unit = FindSiUnit(term.unit, Largest(term.mean))) {
      Scale(unit->factor, &term.mean);
      Scale(unit->factor, &term.error);
      term.unit = unit->to;
    }
    if (const SiUnit* unit = FindSiUnit(term.against_unit, Largest(term.at))) {
      Scale(unit->factor, &term.at);
      term.against_unit = unit->to;
    }
  }
  return diagnosis;
}

}  // namespace hydro::diagnose
