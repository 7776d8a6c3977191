// Values that belong to a run and not to the rig (friction of the day, payload, temperature), as the balances
// show them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// One base parameter with a value for each run. Everything else stays as the model has it.
struct RunValues {
  size_t base = 0;    // in BaseParameters()
  double gain = 0;    // ln of the odds that the parameter differs by run, against one value for all
  double common = 0;  // the one value for all
  std::vector<double> value, low, high;  // of each run, with 95 % intervals
};

// None where no balance of the runs has the parameter, or where balances are measured by it (k_1, k_2).
std::optional<RunValues> ValuesOfRuns(const model::ModelDescription& model,
                                      const std::vector<const RunData*>& runs, size_t base, int jobs);

// Parameters that may differ from day to day: friction with the temperature, the load, the charge pressure.
// Indices in BaseParameters(), from those `allowed`.
std::vector<size_t> ValuesOfADay(const std::vector<size_t>& allowed);

}  // namespace hydro::diagnose
