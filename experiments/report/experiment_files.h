// What the user asks hydro-experiment to do, and its results as files and as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// What the user asks hydro-experiment to do.
struct ExperimentRequest {
  std::string name = "all";                // or an experiment's name
  std::string folder = "out/experiments";  // created if missing
  int jobs = 2;  // number of experiments that run at the same time, and of threads of one
  bool si = false;
  bool real_time = false;  // for the record only; options.run_stack decides
  ExperimentOptions options = {};
};

// The files of an experiment: NAME.json, NAME.csv, NAME.svg and further pictures.
struct RenderedPicture {
  std::string name;  // NAME and the picture's suffix
  std::string svg;   // the file
  std::string html;  // for the report's page
};

// Throws as FigureFile() does, and std::logic_error for a repeated suffix.
std::vector<RenderedPicture> RenderPictures(const std::string& name, const std::vector<Picture>& pictures);

// The result's numbers with name, title, program version, options, conditions, comparisons and findings;
// values that are not finite become null. Throws std::logic_error when the numbers are not a JSON object or
// use one of those keys.
std::string ExperimentJson(const Experiment& experiment, const ExperimentResult& result,
                           const ExperimentOptions& options, bool real_time);

// Writes all files into `folder`, each whole or not at all. Throws WriteError, or InputError when a file
// cannot be created there.
void WriteExperimentFiles(const std::string& folder, const std::string& name, const std::string& json,
                          const tables::Table& table, const std::vector<RenderedPicture>& pictures);

// Results as text for a terminal.

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
