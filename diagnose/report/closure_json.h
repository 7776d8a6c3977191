// Closures in report.json. Only for the files of diagnose/report/: it exposes the JSON library's types.
#pragma once

#include <nlohmann/json.hpp>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// The largest closure, with those of other balances that belong to it under "also"; null without any.
nlohmann::ordered_json ClosureJson(const Diagnosis& diagnosis);

}  // namespace hydro::diagnose
