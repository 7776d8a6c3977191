#include "experiments/studies/experiment.h"

#include <nlohmann/json.hpp>

#include "base/json_text.h"

namespace hydro::experiments {

std::string JsonText(const nlohmann::json& value) { return hydro::JsonText(value, 2); }

nlohmann::json ParseJson(const std::string& text) { return nlohmann::json::parse(text); }

nlohmann::json IntervalJson(const maths::Estimate& estimate) { return {estimate.low, estimate.high}; }

}  // namespace hydro::experiments
