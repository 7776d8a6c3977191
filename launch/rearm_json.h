// The result of a re-arm as JSON.
#pragma once

#include <string>

#include "launch/logic/operator_request.h"

namespace hydro::launch {

// One line with `rearmed`, `text`, and `forecasts`, which state what the machine does after the re-arm; a
// limb has one for each joint. A forecast that is not known has null for its numbers.
std::string RearmJson(const OperatorResult& result);

// The forecasts alone, as a list.
std::string ForecastsJson(const OperatorResult& result);

}  // namespace hydro::launch
