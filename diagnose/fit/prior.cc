#include "diagnose/fit/prior.h"

#include <cmath>
#include <string>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/fit/intervals.h"
#include "model/response.h"

namespace hydro::diagnose {
namespace {

// How far a base parameter that is given as 0 may be from 0: the size of the pump's greatest torque, of the
// pressure that it holds, and of its flow and friction at 100 rad/s. This only keeps parameters that no run
// shows from drifting.
double VagueDeviation(const model::Parameters& given, const std::string& name) {
  constexpr double kSpeed = 100;  // rad/s
  const double pressure = given.T_pmax / given.D;
  if (name == "f") return given.D;
  if (name == "b") return given.T_pmax / kSpeed;
  if (name == "c_E" || name == "c_I") return given.D * kSpeed / pressure;
  if (name == "p_3") return pressure;
  if (name == "mgl") return given.k_2 * pressure;
  return given.T_pmax;
}

// A free number's given value and standard deviation, as fitted; a deviation of 0 where nothing is known.
struct Beforehand {
  double value = 0, deviation = 0;
};

Beforehand KnownBase(const model::ModelDescription& given, const FreeParameter& parameter) {
  const double value = given.parameters.*model::BaseParameters()[parameter.unknown.index].member;
  const double relative = model::UncertaintyOf(given, parameter.unknown.index);
  if (value == 0) return {value, VagueDeviation(given.parameters, parameter.name)};
  return {value, parameter.logarithmic ? relative : relative * std::abs(value)};
}

Beforehand KnownNumber(const model::ModelDescription& given, const Hypothesis& hypothesis,
                       const FreeParameter& parameter) {
  const model::EffectParameter number = model::EffectParameters(hypothesis.model)[parameter.unknown.index];
  // Effects that were added come after those that the model has.
  if (number.effect >= given.effects.size() || !number.IsStated(given)) return {};
  model::ModelDescription copy = given;
  const double value = number.In(&copy), deviation = DeviationOf(given, number);
  return {value, parameter.logarithmic && value > 0 ? deviation / value : deviation};
}

}  // namespace

double DeviationOf(const model::ModelDescription& given, const model::EffectParameter& number) {
  constexpr double kEstimated = 0.3, kPhase = 0.1;
  const model::EffectDescription& effect = given.effects[number.effect];
  const model::ParameterInfo& info = ParameterOf(effect, number.name);
  if (info.role == model::Role::kPeriods) return 0;
  if (info.role == model::Role::kPhase) return kPhase;
  model::ModelDescription copy = given;
  const double value = number.In(&copy);
  for (size_t base = 0; info.sides != nullptr && base < model::BaseParameters().size(); ++base) {
    const bool of = model::BaseParameters()[base].member == info.sides;
    // Half of the difference of two sides that are each known so well, relative to their mean.
    if (of) return model::UncertaintyOf(given, base) * (1 - value * value) / std::sqrt(2.0);
  }
  return kEstimated * std::abs(value);
}

bool IsYardstick(double model::Parameters::*member, const std::vector<const RunData*>& runs) {
  if (member != &model::Parameters::k_1 && member != &model::Parameters::J) return false;
  const bool driven = AreDriven(runs);
  if (member == &model::Parameters::J) return !driven;
  return !driven || !HaveOil(runs);
}

double CostOfLying(double deviations) { return std::log1p(deviations * deviations); }

Prior KnownBefore(const Hypothesis& hypothesis) {
  Prior prior;
  for (const FreeParameter& parameter : hypothesis.Free()) {
    prior.centre.push_back(parameter.ToFitted(parameter.value));
    prior.weight.push_back(0);
    const Knowledge* known = hypothesis.known.get();
    if (known == nullptr) continue;
    const Beforehand before = parameter.unknown.kind == model::Unknown::Kind::kBase
                                  ? KnownBase(known->given, parameter)
                                  : KnownNumber(known->given, hypothesis, parameter);
    if ((parameter.logarithmic && before.value <= 0) || !(before.deviation > 0)) continue;
    prior.centre.back() = parameter.ToFitted(before.value);
    prior.weight.back() = known->weight / (before.deviation * before.deviation);
  }
  return prior;
}

Prior KnownToAFit(const Hypothesis& hypothesis) {
  Prior prior = KnownBefore(hypothesis);
  const MeasuredValues* measured = hypothesis.measured.get();
  if (measured == nullptr || hypothesis.known == nullptr) return prior;
  const std::vector<FreeParameter> free = hypothesis.Free();
  for (size_t i = 0; i < free.size(); ++i) {
    const auto sure = measured->deviation.find(free[i].unknown.index);
    if (free[i].unknown.kind != model::Unknown::Kind::kBase || sure == measured->deviation.end()) continue;
    const auto member = model::BaseParameters()[sure->first].member;
    const double given = hypothesis.known->given.parameters.*member, value = measured->values.*member;
    const double deviation = sure->second * (free[i].logarithmic || given == 0 ? 1 : std::abs(given));
    if (!(deviation > 0) || (free[i].logarithmic && value <= 0)) continue;
    const double weight = hypothesis.known->weight / (kTemperature * deviation * deviation);
    const double both = prior.weight[i] + weight;
    prior.centre[i] = (prior.weight[i] * prior.centre[i] + weight * free[i].ToFitted(value)) / both;
    prior.weight[i] = both;
  }
  return prior;
}

}  // namespace hydro::diagnose
