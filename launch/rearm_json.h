// The result of a re-arm as JSON.
#pragma once

#include <string>

#include "launch/logic/operator_request.h"

namespace hydro::launch {

// On one line: `rearmed`, `text`, and `forecasts`, what the machine does by it, of a limb one for each joint.
// A forecast that is not known has null for its numbers.
std::string RearmJson(const OperatorResult& result);

// The forecasts alone, a list.
std::string ForecastsJson(const OperatorResult& result);

}  // namespace hydro::launch
