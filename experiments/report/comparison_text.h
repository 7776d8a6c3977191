// Results for a person at a terminal.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// An aligned table: quantity, paper, independent, here, unit; a remark stands below its row. With `si`, units
// that have an SI one are converted; what the paper says is converted where it is a number, else its unit is
// named beside it.
std::string ComparisonsText(const std::vector<Comparison>& comparisons, bool si);

// The same rows in SI; the function behind --si.
std::vector<Comparison> InSi(const std::vector<Comparison>& comparisons);

// A value as it is shown to a person: five digits; "-" for NaN.
std::string ShownNumber(double value);

// All that is shown of an experiment: title, comparisons, explanation, findings.
std::string SummaryText(const Experiment& experiment, const ExperimentResult& result, bool si);

}  // namespace hydro::experiments
