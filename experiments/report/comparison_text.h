// Results as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// An aligned table with the columns quantity, paper, independent, here, unit, and with any remark below its
// row. With `si`, units that have an SI equivalent are converted. The paper's value is converted when it is a
// number; otherwise its unit is named beside it.
std::string ComparisonsText(const std::vector<Comparison>& comparisons, bool si);

// The same rows in SI units, for --si.
std::vector<Comparison> InSi(const std::vector<Comparison>& comparisons);

// A value for display: five digits; "-" for NaN.
std::string ShownNumber(double value);

// The whole text of an experiment: title, comparisons, explanation, findings.
std::string SummaryText(const Experiment& experiment, const ExperimentResult& result, bool si);

}  // namespace hydro::experiments
