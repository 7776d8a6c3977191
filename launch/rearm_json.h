// The result of a re-arm, for a terminal and as JSON.
#pragma once

#include <cstddef>
#include <string>

#include "launch/logic/operator_request.h"

namespace hydro::launch {

// The result of a re-arm as lines of at most kTerminalColumns, with a line end each: "hydro-launch: re-armed:
// ended pressure_limit.", and a sentence a line for what the machine does after it.
std::string TerminalText(const OperatorResult& result);
inline constexpr size_t kTerminalColumns = 100;

// One line with `rearmed`, `text`, and `forecasts`, which state what the machine does after the re-arm; a
// limb has one for each joint. A forecast that is not known has null for its numbers.
std::string RearmJson(const OperatorResult& result);

// The forecasts alone, as a list.
std::string ForecastsJson(const OperatorResult& result);

}  // namespace hydro::launch
