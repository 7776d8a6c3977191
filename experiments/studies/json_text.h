// JSON to text and back: nlohmann's writer and parser, compiled once, because they cost seconds in each file
// that uses them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/maths/estimate.h"

namespace hydro::experiments {

// Indented by 2; values that are not finite become null.
std::string JsonText(const nlohmann::json& value);

// Throws nlohmann::json::parse_error.
nlohmann::json ParseJson(const std::string& text);

// [low, high].
nlohmann::json IntervalJson(const maths::Estimate& estimate);

}  // namespace hydro::experiments
