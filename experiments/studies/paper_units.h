// Experiments state their results in the paper's units. Here a measured run, and what is known of its
// machine, come into these units from those of the run's own model.
#pragma once

#include <string>

#include "base/unit_system.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::experiments {

// The paper's unit of a quantity, in that of a model in `units`: 6894.76 for "psi" and a model in SI, exactly
// 1 for one in the paper's units. `arm` as in UnitSystem::UnitFor. The position of a linear arm, of which the
// paper has none, is in "in".
double PaperUnitIn(const UnitSystem& units, const std::string& paper, int arm = 0);

// The model's base parameters in the paper's units.
model::Parameters PaperParameters(const model::ModelDescription& model);

struct RunAndModel {
  runs::MeasuredRun run;  // in the paper's units
  // Of the run's log, else Table 1. It stays in its own units: formulas written as text have numbers in them.
  model::ModelDescription model;
};

// Reads the run that an experiment is to analyse. Throws InputError as ReadMeasuredRun and
// RequirePossibleSamples.
RunAndModel ReadRunAndModel(const std::string& file);

}  // namespace hydro::experiments
