#include "model/response.h"

#include <algorithm>

#include "model/response_pass.h"

namespace hydro::model {
namespace {

void PassWithDerivatives(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
                         const std::vector<Unknown>& unknowns, size_t first, const ResponseOptions& options,
                         Response* response) {
#ifdef HYDRO_WIDE_VECTORS
  static const bool wide = __builtin_cpu_supports("avx512f") != 0;
  if (wide) return WidePass(model, stimulus, start, unknowns, first, options, response);
#endif
  Pass<Jet>(model, stimulus, start, unknowns, first, options, response);
}

}  // namespace

std::string EffectParameter::Label() const {
  return place.has_value() ? name + "[" + std::to_string(*place) + "]" : name;
}

bool EffectParameter::IsStated(const ModelDescription& model) const {
  return place.has_value() || model.effects[effect].parameters.contains(name);
}

double& EffectParameter::In(ModelDescription* model) const {
  EffectDescription& owner = model->effects[effect];
  if (place.has_value()) return owner.lists.at(name).at(*place);
  const auto stated = owner.parameters.find(name);
  if (stated != owner.parameters.end()) return stated->second;
  return owner.parameters[name] = NumberOf(owner, ParameterOf(owner, name), model->parameters);
}

std::vector<EffectParameter> EffectParameters(const ModelDescription& model) {
  std::vector<size_t> order(model.effects.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return ComesBefore(model.effects[a], model.effects[b]); });
  std::vector<EffectParameter> parameters;
  for (const size_t i : order) {
    const EffectInfo* info = FindEffect(model.effects[i]);
    if (info == nullptr) throw ModelError("effect \"" + model.effects[i].id + "\" is not known");
    for (const ParameterInfo& parameter : info->parameters) {
      if (parameter.is_number()) parameters.push_back({i, parameter.name});
      if (parameter.list != List::kValues) continue;
      const size_t count = model.effects[i].lists.at(parameter.name).size();
      for (size_t place = 0; place < count; ++place) parameters.push_back({i, parameter.name, place});
    }
  }
  return parameters;
}

Response Respond(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
                 const std::vector<Unknown>& unknowns, const ResponseOptions& options) {
  const size_t rows = (stimulus.time.size() + options.stride - 1) / options.stride;
  Response response;
  response.derivatives.resize(unknowns.size());
  for (size_t c = 0; c < kChannels; ++c) {
    if (!options.channels[c]) continue;
    response.values[c].resize(rows);
    for (auto& derivative : response.derivatives) derivative[c].resize(rows);
  }
  if (unknowns.empty()) {
    Pass<double>(model, stimulus, start, unknowns, 0, options, &response);
  } else {
    for (size_t first = 0; first < unknowns.size(); first += kJetWidth) {
      PassWithDerivatives(model, stimulus, start, unknowns, first, options, &response);
    }
  }
  return response;
}

}  // namespace hydro::model
