// The forecast of a re-arm as one line for a person.
#pragma once

#include <string>

#include "tune/live/rearm_forecast.h"

namespace hydro::tuning {

// Clauses between semicolons. `what` names the quantity that the reference refers to: "the arm".
std::string ForecastText(const RearmForecast& forecast, const std::string& what,
                         const settings::StackConfig& config);

}  // namespace hydro::tuning
