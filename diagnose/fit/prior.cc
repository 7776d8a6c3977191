#include "diagnose/fit/prior.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/fit/intervals.h"

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

}  // namespace

double CostOfLying(double deviations) { return std::log1p(deviations * deviations); }

double OddsLostBy(const model::Parameters& values, const model::ModelDescription& given) {
  constexpr double kExpected = 2;    // standard deviations: 19 of 20 values lie closer
  constexpr double kNothing = 0.01;  // of a value: less counts as none
  double lost = 0;
  for (size_t base = 0; base < model::BaseParameters().size(); ++base) {
    const auto member = model::BaseParameters()[base].member;
    const double deviation = model::UncertaintyOf(given, base);
    if (given.parameters.*member == 0 || !(deviation > 0)) continue;
    const double ratio = std::max(kNothing, values.*member / (given.parameters.*member));
    const double away = std::abs(std::log(ratio)) / deviation;
    if (away > kExpected) lost += CostOfLying(away) - CostOfLying(kExpected);
  }
  return lost;
}

Prior KnownBefore(const Hypothesis& hypothesis) {
  Prior prior;
  for (const FreeParameter& parameter : hypothesis.Free()) {
    prior.centre.push_back(parameter.ToFitted(parameter.value));
    prior.weight.push_back(0);
    const Knowledge* known = hypothesis.known.get();
    if (known == nullptr || parameter.unknown.kind != model::Unknown::Kind::kBase) continue;
    const size_t base = parameter.unknown.index;
    const double given = known->given.parameters.*model::BaseParameters()[base].member;
    if (parameter.logarithmic && given <= 0) continue;
    const double relative = model::UncertaintyOf(known->given, base);
    const double deviation = given == 0              ? VagueDeviation(known->given.parameters, parameter.name)
                             : parameter.logarithmic ? relative
                                                     : relative * std::abs(given);
    if (!(deviation > 0)) continue;
    prior.centre.back() = parameter.ToFitted(given);
    prior.weight.back() = known->weight / (deviation * deviation);
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
