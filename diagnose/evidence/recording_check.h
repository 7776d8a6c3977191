// Looks for mistakes in recordings before any physics: signs, exchanged channels, units and the shaft. A mistake is a change of the
// recording, and the evidence of the balances judges it: nothing is simulated.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/recording/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// What explains a run far better than its sidecar.
struct RecordingFinding {
  size_t run = 0;
  std::vector<RecordingMistake> mistakes;
  double gain = 0;  // of the log evidence
  // Others that explain the runs as well: no more mistakes than these, or one more.
  std::vector<std::vector<RecordingMistake>> tied = {};
};

// One finding at most for each run, in their order. `unpredicted`: runs of which nothing is found, and of which the model as given
// closes no balance at all, so that nothing can be said. The results do not depend on `jobs`. What `time_is_up` cuts off is not found.
std::vector<RecordingFinding> CheckRecordings(
    const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs, int jobs,
    const std::function<bool()>& time_is_up = [] { return false; },
    std::vector<size_t>* unpredicted = nullptr);

// One line for each kind of finding: what is wrong, in which runs, and the sidecars' lines that mend it.
std::vector<std::string> FindingRemarks(const std::vector<RecordingFinding>& findings,
                                        const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::diagnose
