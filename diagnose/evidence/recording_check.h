// Looks for mistakes in recordings before any physics: signs, exchanged channels, units and the shaft. Each
// mistake is a change of the recording, and the evidence of the balances judges it. Nothing is simulated.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/recording/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// Mistakes that explain a run far better than its sidecar does.
struct RecordingFinding {
  size_t run = 0;
  std::vector<RecordingMistake> mistakes;
  // Other sets that explain the runs as well, with no more mistakes than these or with one more.
  std::vector<std::vector<RecordingMistake>> tied = {};
};

// Runs without a finding of which nothing can be said.
struct UnjudgedRuns {
  std::vector<size_t> unpredicted;  // the given model closes no balance at all
  std::vector<size_t> at_rest;      // the motor hardly turns: the balances consist of noise
  std::vector<size_t> unbalanced;   // no stretch long enough for a balance, or without its signals
};

// Returns at most one finding for each run, in the order of the runs. `unjudged` receives runs without one.
// The results do not depend on `jobs`. Mistakes that `time_is_up` cuts off are not found.
std::vector<RecordingFinding> CheckRecordings(
    const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs, int jobs,
    const std::function<bool()>& time_is_up = [] { return false; }, UnjudgedRuns* unjudged = nullptr);

// One line for each kind of finding: what is wrong, in which runs, and which lines of the sidecars correct
// it.
std::vector<std::string> FindingRemarks(const std::vector<RecordingFinding>& findings,
                                        const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::diagnose
