// The report of all experiments: one self-contained HTML page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/report/experiment_files.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// The number of the paper's contradictions and open questions that the experiments together must show; they
// are numbered from 1.
inline constexpr int kFindings = 10;

struct ReportEntry {
  Experiment experiment;
  std::optional<ExperimentResult> result;  // none if the experiment failed
  std::vector<RenderedPicture> pictures;
  std::string failure;  // why
};

// Numbers of the findings, 1 to kFindings, for which no result has evidence.
std::vector<int> MissingFindings(const std::vector<ReportEntry>& entries);

// Pictures are inline; there are no scripts, no external references and no time of day, so identical results
// give identical bytes. `request` says how the results were made (its folder is not shown).
std::string ReportHtml(const std::vector<ReportEntry>& entries, const ExperimentRequest& request);

}  // namespace hydro::experiments
