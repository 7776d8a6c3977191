#include "diagnose/verdict/plausible.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

namespace {

constexpr double kRemarkable = 2;
constexpr double kDecades = 10;

struct Limit {
  const char* name;
  double most;
};

// Numbers without a unit, and rates, well beyond what is found in hydraulics.
constexpr Limit kLimits[] = {
    {"pump.stribeck.static_excess", 10},  // static friction eleven times the kinetic one
    {"fluid.entrained_air.air_fraction", 0.5},
    {"fluid.stiffening.slope", 1000},  // oils: 5 to 15
    {"fluid.warming.rate", 10},        // 1/s
    {"sensor.pressure_gain.gain", 1},
};

// A ratio above 1, whichever way a number moves.
double Factor(double value, double given) {
  const double ratio = value / given;
  if (!(ratio > 0)) return std::numeric_limits<double>::infinity();
  return std::max(ratio, 1 / ratio);
}

bool MovesByDecades(const ChangedParameter& changed) {
  if (changed.model == 0 || Factor(changed.fitted.value, changed.model) < kDecades) return false;
  const double nearest = std::clamp(changed.model, changed.fitted.low, changed.fitted.high);
  return Factor(nearest, changed.model) > kRemarkable;
}

double MostOf(const model::EffectInfo& info, const model::ParameterInfo& parameter,
              const model::Parameters& given) {
  for (const Limit& limit : kLimits) {
    if (info.id + "." + parameter.name == limit.name) return limit.most;
  }
  const bool of_the_pump = info.id.starts_with("pump.") || info.id.starts_with("motor.");
  if (parameter.unit == "in-lbf" && of_the_pump) return given.T_pmax;
  if (parameter.unit == "psi") return 0.1 * given.beta;
  if (parameter.unit == "s") return 0.5;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

std::string WhyRemarkable(const ChangedParameter& changed) {
  if (changed.model == 0 || Factor(changed.fitted.value, changed.model) <= kRemarkable) return "";
  return "moves by a factor of " + ShortNumber(changed.fitted.value / changed.model, 3);
}

std::vector<std::string> Implausible(const std::vector<ChangedParameter>& parameters,
                                     const std::vector<FoundEffect>& effects,
                                     const model::Parameters& given) {
  std::vector<std::string> lines;
  for (const ChangedParameter& changed : parameters) {
    if (!MovesByDecades(changed)) continue;
    lines.push_back(changed.fitted.name + " = " + ShortNumber(changed.fitted.value) + " instead of " +
                    ShortNumber(changed.model));
  }
  for (const FoundEffect& effect : effects) {
    const model::EffectInfo& info = *model::FindEffect(effect.id);
    for (const Estimated& found : effect.parameters) {
      for (const model::ParameterInfo& parameter : info.parameters) {
        const double most = MostOf(info, parameter, given);
        if (parameter.name != found.name || !(std::abs(found.value) > most)) continue;
        lines.push_back(effect.id + "." + found.name + " = " + ShortNumber(found.value) + ", above " +
                        ShortNumber(most));
      }
    }
  }
  return lines;
}

}  // namespace hydro::diagnose
