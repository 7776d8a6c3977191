// The report of all experiments: one HTML page that needs nothing else.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/report/experiment_files.h"
#include "experiments/report/experiment_request.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// The paper's contradictions and open ends that the experiments together must show, numbered 1 to this.
inline constexpr int kFindings = 10;

struct ReportEntry {
  Experiment experiment;
  std::optional<ExperimentResult> result;  // none: it failed
  std::vector<RenderedPicture> pictures;
  std::string failure;  // why
};

// Numbers of the findings, 1 to kFindings, that no result has with evidence.
std::vector<int> MissingFindings(const std::vector<ReportEntry>& entries);

// Pictures inline, no scripts, no reference to anything outside, no time of day: identical results give
// identical bytes. `request` says how they were made (its folder is not told).
std::string ReportHtml(const std::vector<ReportEntry>& entries, const ExperimentRequest& request);

}  // namespace hydro::experiments
