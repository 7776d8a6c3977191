// Looks for mistakes in recordings before any physics: signs, exchanged channels, units and the shaft. A mistake is far
// larger than what any model lacks, so balances of the signals and short predictions with the model as given tell it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/data/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// What explains a run far better than its sidecar.
struct RecordingFinding {
  size_t run = 0;
  std::vector<RecordingMistake> mistakes;
  // Median squared errors of predictions over some 0.05 s, by signals the worst; 1: a tenth of the movement.
  double as_recorded = 0, corrected = 0;
  double gain = 0;  // logarithm of the fall of the squared error over all signals, in the median window
  // Others that explain the runs as well: no more mistakes than these, or one more.
  std::vector<std::vector<RecordingMistake>> tied = {};
};

// One finding at most for each run, in their order. `unpredicted`: runs of which nothing is found, and which the model as given does not
// predict at all, so that nothing can be said. Takes a second or two for eight runs; the results do not
// depend on `jobs`. What `time_is_up` cuts off is not found.
std::vector<RecordingFinding> CheckRecordings(
    const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs, int jobs,
    const std::function<bool()>& time_is_up = [] { return false; },
    std::vector<size_t>* unpredicted = nullptr);

// Without what one run of several says alone and weakly, if it is not in order then: what is missing there may look like a mistake.
std::vector<RecordingFinding> WithoutDoubtful(size_t runs, const std::vector<RecordingFinding>& findings);

// One line for each kind of finding: what is wrong, in which runs, and the sidecars' lines that mend it.
std::vector<std::string> FindingRemarks(const std::vector<RecordingFinding>& findings,
                                        const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::diagnose
