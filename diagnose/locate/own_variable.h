// The variable over which each effect of the catalogue is best seen.
#pragma once

#include <string>
#include <vector>

#include "diagnose/locate/disturbance_smoother.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// A balance that the effect adds to, and a variable by its name in Explanations::States.
struct OwnVariable {
  Balance balance = Balance::kPumpTorque;
  std::string variable;
};

// The likeliest first; empty for effects that act through time, as lags and late sensors do.
std::vector<OwnVariable> OwnVariables(const model::EffectDescription& effect);

}  // namespace hydro::diagnose
