#include "diagnose/fit/likeliest_scale.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "model/effects/catalogue.h"
#include "model/response.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {
namespace {

using model::Parameters;

// Logarithm of a factor: values that are twice as large are another machine's. The search's step is finer
// than anything is known.
constexpr double kMostScale = 0.7, kScaleStep = 1e-3;
// Nats: less is not worth more than a bare mention (Kass and Raftery, 1995).
constexpr double kWorthMoving = 1;

// Logarithms of the two factors.
struct Scale {
  double flows = 0;        // of torques, flows and volumes
  double compression = 0;  // of the volume at mid-stroke and the bulk modulus
};

// A value, its distance from the given one, and the powers with which it follows the factors.
struct Follower {
  double Parameters::*member = nullptr;
  double moved = 0;      // logarithm of the value over the given one
  double deviation = 0;  // relative, as it is known
  double flows = 0, compression = 0;

  double By(const Scale& scale) const { return flows * scale.flows + compression * scale.compression; }
};

bool Has(const std::vector<size_t>& base, const char* name) {
  return std::ranges::find(base, model::BasePlace(name)) != base.end();
}

// The powers of a base value. Where the volume at mid-stroke may not move, the bulk modulus moves instead.
Follower FollowerOf(double Parameters::*member, bool volume_moves) {
  if (member == &Parameters::V_ms) return {member, 0, 0, 1, 1};
  if (member == &Parameters::beta) return {member, 0, 0, volume_moves ? 0.0 : -1.0, volume_moves ? 1.0 : 0.0};
  for (double Parameters::*follows :
       {&Parameters::k_1, &Parameters::T_pmax, &Parameters::D, &Parameters::J, &Parameters::b,
        &Parameters::T_s, &Parameters::f, &Parameters::c, &Parameters::c_E, &Parameters::c_I}) {
    if (member == follows) return {member, 0, 0, 1, 0};
  }
  return {};
}

std::vector<Follower> FollowersOf(const model::ModelDescription& given, const std::vector<size_t>& base,
                                  const std::vector<Change>& changes, const Parameters& values) {
  std::vector<Follower> followers;
  const bool volume_moves = Has(base, "V_ms");
  for (const size_t place : base) {
    const model::BaseParameter& one = model::BaseParameters()[place];
    Follower follower = FollowerOf(one.member, volume_moves);
    const double before = given.parameters.*one.member, now = values.*one.member;
    if (follower.member == nullptr || !(before > 0) || !(now > 0)) continue;
    const bool named =
        std::ranges::any_of(changes, [&](const Change& change) { return change.parameter == one.info.name; });
    follower.deviation = named ? 1 : model::UncertaintyOf(given, place);
    follower.moved = std::log(now / before);
    if (follower.deviation > 0) followers.push_back(follower);
  }
  return followers;
}

// Minus the logarithm of how likely the values are at the scale.
double CostOf(const std::vector<Follower>& followers, const Scale& scale) {
  double cost = 0;
  for (const Follower& one : followers) cost += CostOfLying((one.moved + one.By(scale)) / one.deviation);
  return cost;
}

// The second factor takes one of the values that follow it back to where it was given, or each a part of the
// way.
std::vector<double> CompressionsAt(const std::vector<Follower>& followers, double flows) {
  std::vector<double> tried = {0};
  double sum = 0, weights = 0;
  for (const Follower& one : followers) {
    if (one.compression == 0) continue;
    const double back = -(one.moved + one.flows * flows) / one.compression;
    tried.push_back(back);
    sum += back * std::pow(one.deviation, -2);
    weights += std::pow(one.deviation, -2);
  }
  if (weights > 0) tried.push_back(sum / weights);
  return tried;
}

Scale Likeliest(const std::vector<Follower>& followers) {
  Scale best;
  double least = CostOf(followers, best) - kWorthMoving;
  for (double flows = -kMostScale; flows <= kMostScale; flows += kScaleStep) {
    for (const double compression : CompressionsAt(followers, flows)) {
      const double cost = CostOf(followers, {flows, compression});
      if (cost >= least) continue;
      least = cost;
      best = {flows, compression};
    }
  }
  return best;
}

// The power of a motor's torque, a flow or a volume in the unit. The torques of an arm are not measured by
// the motor's.
int PowerOf(const model::ParameterInfo& info) {
  const std::string_view unit = info.unit;
  if (unit.starts_with("in^3")) return 1;
  if (unit.find("/in^3") != std::string_view::npos) return -1;
  return info.arm == 0 && (unit.starts_with("in-lbf") || unit.starts_with("lbf-in")) ? 1 : 0;
}

void ScaleEffects(double logarithm, model::ModelDescription* model) {
  for (model::EffectDescription& effect : model->effects) {
    const model::EffectInfo* known = model::FindEffect(effect.id);
    if (known == nullptr) continue;
    for (const model::ParameterInfo& info : known->parameters) {
      const double by = std::exp(PowerOf(info) * logarithm);
      const auto number = effect.parameters.find(info.name);
      if (number != effect.parameters.end() && by != 1)
        number->second = std::clamp(number->second * by, info.min, info.max);
      const auto list = effect.lists.find(info.name);
      if (list == effect.lists.end() || info.list != model::List::kValues) continue;
      for (double& value : list->second) value *= by;
    }
  }
}

}  // namespace

void MoveToLikeliestScale(const model::ModelDescription& given, const std::vector<size_t>& base,
                          const std::vector<Change>& changes, model::ModelDescription* model) {
  if (!Has(base, "k_1") || !Has(base, "D")) return;
  const std::vector<Follower> followers = FollowersOf(given, base, changes, model->parameters);
  const Scale scale = Likeliest(followers);
  for (const Follower& one : followers) model->parameters.*one.member *= std::exp(one.By(scale));
  if (scale.flows != 0) ScaleEffects(scale.flows, model);
}

bool FollowsTorques(const model::ModelDescription& model, const FreeParameter& parameter) {
  const size_t place = parameter.unknown.index;
  if (parameter.unknown.kind == model::Unknown::Kind::kBase) {
    const auto member = model::BaseParameters()[place].member;
    const auto torques = {&Parameters::k_1, &Parameters::T_pmax, &Parameters::J,
                          &Parameters::b,   &Parameters::T_s,    &Parameters::f};
    return std::ranges::find(torques, member) != torques.end();
  }
  const model::EffectParameter number = model::EffectParameters(model)[place];
  const model::ParameterInfo& info = ParameterOf(model.effects[number.effect], number.name);
  return info.unit.find("lbf") != std::string::npos && PowerOf(info) == 1;
}

void MoveToLikeliestScale(const model::ModelDescription& given, Hypothesis* hypothesis) {
  MoveToLikeliestScale(given, hypothesis->base, hypothesis->changes, &hypothesis->model);
}

}  // namespace hydro::diagnose
