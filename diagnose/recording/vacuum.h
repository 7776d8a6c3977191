// Measured pressures that no fluid has: readings below absolute zero.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/recording/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

struct BelowVacuum {
  double lowest = 0;     // in the model's unit
  double zero = 0;       // absolute zero there, as a gauge reads it
  size_t samples = 0;    // below it
  bool lasting = false;  // the median of a stretch is below it, so noise is not the reason
};

// Empty when no sample of the pressure is below absolute zero. Counts from the surrounding air, because an
// absolute reading cannot be told from one of a gauge.
std::optional<BelowVacuum> FindBelowVacuum(const model::ModelDescription& model,
                                           const runs::MeasuredSignal& pressure);

// "5 samples are below -101325 Pa, a vacuum: ..."; `unit` and `factor` state how pressures are shown.
std::string Text(const BelowVacuum& below, double factor, const std::string& unit);

// One line for each pressure that is below absolute zero in some of the runs; `lasting` gets those that noise
// does not explain, `brief` the others.
void AddVacuumRemarks(const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs,
                      std::vector<std::string>* lasting, std::vector<std::string>* brief);

}  // namespace hydro::diagnose
