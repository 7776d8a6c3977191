#include "diagnose/fit/hypothesis.h"

#include <algorithm>
#include <cmath>

namespace hydro::diagnose {
namespace {

// How far a fit may move from an effect's starting points: by this factor, up or down.
constexpr double kReach = 300;

// A number of an effect that a fit moves, and its place among the model's EffectParameters().
struct FreeEffectNumber {
  model::EffectParameter parameter;
  size_t place = 0;
  double value = 0;
};

// The free ones. Poles, teeth and pistons are counted, not measured, so a whole number of periods stays.
std::vector<FreeEffectNumber> FreeEffectNumbers(const Hypothesis& hypothesis) {
  std::vector<FreeEffectNumber> free;
  model::ModelDescription model = hypothesis.model;
  const std::vector<model::EffectParameter> all = model::EffectParameters(model);
  for (size_t i = 0; i < all.size(); ++i) {
    const model::EffectDescription& effect = model.effects[all[i].effect];
    const std::vector<std::string>& moved = hypothesis.effects;
    if (std::ranges::find(moved, effect.id) == moved.end()) continue;
    if (!all[i].IsStated(model)) continue;
    const double value = all[i].In(&model);
    const bool periods = ParameterOf(effect, all[i].name).role == model::Role::kPeriods;
    if (!periods || value != std::round(value)) free.push_back({all[i], i, value});
  }
  return free;
}

}  // namespace

bool IsFitted(const model::EffectInfo& effect, const model::ParameterInfo& number) {
  return !number.optional || effect.on_request;
}

std::string Change::Label() const {
  if (effect.empty()) return "parameter " + parameter;
  std::string label = effect;
  for (const auto& [name, value] : names) label += " (" + value + ")";
  return label;
}

double FreeParameter::ToFitted(double number) const { return logarithmic ? std::log(number) : number; }
double FreeParameter::FromFitted(double fitted) const { return logarithmic ? std::exp(fitted) : fitted; }
double FreeParameter::Moved(double by) const { return logarithmic ? value * std::exp(by) : value + by; }

ValueReach ReachOf(const model::Parameters& given, const model::Parameters& estimated) {
  ValueReach reach;
  for (const model::BaseParameter& base : model::BaseParameters()) {
    const auto [least, most] = std::minmax(given.*base.member, estimated.*base.member);
    const bool scales = least > 0;
    reach.low.*base.member = scales && !base.info.min_allowed ? least / kImplausible : -INFINITY;
    reach.high.*base.member = scales ? most * kImplausible : INFINITY;
  }
  return reach;
}

std::vector<FreeParameter> Hypothesis::Free() const {
  std::vector<FreeParameter> free;
  for (const size_t i : base) {
    const model::ParameterInfo& info = model::BaseParameters()[i].info;
    const double value = model.parameters.*model::BaseParameters()[i].member;
    FreeParameter parameter{
        {model::Unknown::Kind::kBase, i}, info.name, info.UnitIn(model.units), value, info.min, info.max};
    parameter.role = info.role;
    parameter.logarithmic = !info.min_allowed && value > 0;
    if (parameter.logarithmic) {
      parameter.low = value / kReach;
      parameter.high = value * kReach;
    }
    if (reach != nullptr) {
      parameter.low = std::max(parameter.low, reach->low.*model::BaseParameters()[i].member);
      parameter.high = std::min(parameter.high, reach->high.*model::BaseParameters()[i].member);
    }
    free.push_back(parameter);
  }
  for (const FreeEffectNumber& number : FreeEffectNumbers(*this)) {
    const model::EffectDescription& effect = model.effects[number.parameter.effect];
    const model::ParameterInfo& info = ParameterOf(effect, number.parameter.name);
    const double value = number.value;
    FreeParameter parameter{{model::Unknown::Kind::kEffect, number.place},
                            effect.id + "." + number.parameter.Label(),
                            info.UnitIn(model.units),
                            value,
                            info.min,
                            info.max};
    parameter.role = info.role;
    parameter.logarithmic = !info.min_allowed && info.min == 0 && value > 0;
    if (parameter.logarithmic) {
      parameter.low = value / kReach;
      parameter.high = std::min(info.max, value * kReach);
    } else if (!info.min_allowed && std::isfinite(info.min)) {
      parameter.low = info.min + kAboveTheLeast * std::max(1.0, std::abs(info.min));
    }
    const bool within_runs = info.scale == model::Scale::kSpeed && !info.starts.empty() &&
                             *std::ranges::max_element(info.starts) < 1;
    if (within_runs && parameter.low < highest_speed)
      parameter.high = std::min(parameter.high, highest_speed);
    if (parameter.role == model::Role::kFrequency && parameter.low < highest_frequency)
      parameter.high = std::min(parameter.high, highest_frequency);
    if (parameter.role == model::Role::kTime && std::max(0.0, parameter.low) < longest_time)
      parameter.high = std::min(parameter.high, longest_time);
    free.push_back(parameter);
  }
  return free;
}

void Hypothesis::Set(const std::vector<double>& values) {
  size_t next = 0;
  for (const size_t i : base) model.parameters.*model::BaseParameters()[i].member = values[next++];
  for (const FreeEffectNumber& number : FreeEffectNumbers(*this))
    number.parameter.In(&model) = values[next++];
}

bool Hypothesis::Has(const Change& change) const {
  return std::ranges::find(changes, change) != changes.end();
}

double Sizes::Of(model::Scale scale) const {
  switch (scale) {
    case model::Scale::kOne:
      return 1;
    case model::Scale::kTorque:
      return torque;
    case model::Scale::kInertia:
      return inertia;
    case model::Scale::kSpeed:
      return speed;
    case model::Scale::kPressure:
      return pressure;
    case model::Scale::kCharge:
      return charge;
    case model::Scale::kSample:
      return sample;
    case model::Scale::kRate:
      return 1 / sample;
    case model::Scale::kTorqueRate:
      return torque / sample;
    case model::Scale::kFlow:
      return flow;
    case model::Scale::kArmStiffness:
      return arm_stiffness;
    case model::Scale::kArmDamping:
      return arm_damping;
    case model::Scale::kOilStiffness:
      return oil_stiffness;
  }
  return 1;
}

namespace {

// The largest magnitude, but for spikes; 0 without values.
double Largest(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 0;
  for (double& value : values) value = std::abs(value);
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double LargestOf(const SignalData* signal) { return signal == nullptr ? 0 : Largest(signal->values); }

// Of an encoder's angle, over so many samples that its steps count little.
double LargestRate(const SignalData* angle, const std::vector<double>& time) {
  constexpr size_t kApart = 10;
  if (angle == nullptr) return 0;
  std::vector<double> rates;
  for (size_t i = kApart; i < angle->values.size(); i += kApart)
    rates.push_back((angle->values[i] - angle->values[i - kApart]) / (time[i] - time[i - kApart]));
  return Largest(std::move(rates));
}

}  // namespace

Sizes SizesOf(const model::ModelDescription& model, const std::vector<const RunData*>& runs) {
  Sizes sizes;
  const model::Parameters& p = model.parameters;
  sizes.torque = p.T_pmax;
  sizes.inertia = p.J;
  sizes.charge = p.p_3 > 0 ? p.p_3 : 0.01 * p.T_pmax / p.D;
  for (const RunData* run : runs) {
    sizes.speed = std::max({sizes.speed, LargestOf(run->Find(model::Channel::kMotorSpeed)),
                            LargestRate(run->Find(model::Channel::kMotorAngle), run->stimulus.time)});
    sizes.pressure = std::max({sizes.pressure, LargestOf(run->Find(model::Channel::kP1)),
                               LargestOf(run->Find(model::Channel::kP2))});
  }
  if (sizes.speed == 0) sizes.speed = p.T_pmax / std::max(p.b, 0.001 * p.T_pmax);
  if (sizes.pressure == 0) sizes.pressure = p.T_pmax / p.D;
  sizes.sample = SampleInterval(runs);
  sizes.flow = p.D * sizes.speed / sizes.pressure;
  sizes.oil_stiffness = p.V_ms > 0 ? p.beta / p.V_ms : 0;
  sizes.arm_stiffness = 2 * p.c * p.c * sizes.oil_stiffness;
  sizes.arm_damping = 2 * std::sqrt(p.J_a * sizes.arm_stiffness);
  return sizes;
}

namespace {

// The starting values of an effect's parameter in fits.
std::vector<double> StartsOf(const model::ParameterInfo& parameter, const Sizes& sizes) {
  std::vector<double> starts;
  starts.reserve(parameter.starts.size());
  for (const double start : parameter.starts) starts.push_back(start * sizes.Of(parameter.scale));
  return starts;
}

// Frees the base parameter, if it is not free already.
void FreeValue(size_t place, Hypothesis* hypothesis) {
  if (std::ranges::find(hypothesis->base, place) == hypothesis->base.end()) hypothesis->base.push_back(place);
}

// Adds to the starts of the last effect those that take half of the base parameter for the effect's number.
void AddShared(const model::ParameterInfo& number, size_t place, std::vector<Hypothesis>* starts) {
  for (size_t i = 0, size = starts->size(); i < size; ++i) {
    Hypothesis shared = (*starts)[i];
    shared.model.effects.back().parameters[number.name] = shared.model.parameters.*number.part_of *= 0.5;
    FreeValue(place, &shared);
    starts->push_back(std::move(shared));
  }
}

}  // namespace

std::vector<Hypothesis> With(const Hypothesis& hypothesis, const Change& change, const Sizes& sizes,
                             const std::vector<size_t>& movable) {
  Hypothesis more = hypothesis;
  more.changes.push_back(change);
  if (change.effect.empty()) {
    FreeValue(model::BasePlace(change.parameter), &more);
    return {more};
  }
  const model::EffectInfo& info = *model::FindEffect(change.effect);
  more.effects.push_back(change.effect);
  more.model.effects.push_back({change.effect, {}, change.names});
  std::vector<Hypothesis> all = {more};
  for (const model::ParameterInfo& parameter : info.parameters) {
    if (parameter.is_name() || !IsFitted(info, parameter)) continue;
    std::vector<Hypothesis> next;
    for (const Hypothesis& one : all) {
      for (const double start : StartsOf(parameter, sizes)) {
        next.push_back(one);
        next.back().model.effects.back().parameters[parameter.name] = start;
      }
    }
    all = std::move(next);
  }
  for (const model::ParameterInfo& parameter : info.parameters) {
    if (parameter.part_of == nullptr || !IsFitted(info, parameter)) continue;
    for (const size_t place : movable) {
      if (model::BaseParameters()[place].member == parameter.part_of) AddShared(parameter, place, &all);
    }
  }
  return all;
}

Hypothesis Without(const Hypothesis& hypothesis, const Change& change, const model::ModelDescription& given) {
  Hypothesis less = hypothesis;
  std::erase(less.changes, change);
  if (change.effect.empty()) {
    const size_t place = model::BasePlace(change.parameter);
    std::erase(less.base, place);
    less.model.parameters.*model::BaseParameters()[place].member =
        given.parameters.*model::BaseParameters()[place].member;
    return less;
  }
  std::erase(less.effects, change.effect);
  std::erase_if(less.model.effects,
                [&](const model::EffectDescription& effect) { return effect.id == change.effect; });
  return less;
}

}  // namespace hydro::diagnose
