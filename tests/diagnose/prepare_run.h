// PrepareRun() for a model that tests state by its parameters alone.
#pragma once

#include <utility>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

inline RunData PrepareRun(runs::MeasuredRun run, const model::Parameters& parameters) {
  model::ModelDescription plain;  // without effects, so that its sides are equal
  plain.parameters = parameters;
  return PrepareRun(std::move(run), plain);
}

}  // namespace hydro::diagnose
