// The files of an experiment: NAME.json, NAME.csv, NAME.svg and further pictures.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

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

}  // namespace hydro::experiments
