// Recordings whose channels were sampled by devices with separate clocks: how late each clock is, from the balances themselves.
#pragma once

#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// Estimates the clocks of a recording relative to that of p1 and p2 (a common shift cannot be seen) and shifts its signals to it
// (RemoveDelays of runs/run_delays.h). A clock is the column of a late signal in the balances, with a wide prior: Gauss-Newton on their
// evidence, first on rows up to 0.25 Hz, where a large delay is a small change, at last on those up to 2 Hz. All values of the model are
// as good as free there, so that a wrong one is not taken for a delay (late_signals.h).
//
// Command and motor that are both late by 20 ms, two samples or more are another clock, where that is likelier than that one
// signal alone, or the pressures, are late: these have names in the catalogue of effects, and smaller delays too. Otherwise the run stays
// unchanged to the bit and the result is empty.
std::vector<ClockDelay> AlignClocks(const model::ModelDescription& given, runs::MeasuredRun* run);

// A run with all signals on one clock, and the clocks that were found.
struct AlignedRun {
  runs::MeasuredRun run;
  std::vector<ClockDelay> clocks;
};
// Of each run, by AlignClocks(); the same for any number of jobs.
std::vector<AlignedRun> AlignedRuns(const model::ModelDescription& given,
                                    const std::vector<runs::MeasuredRun>& runs, int jobs);

// PrepareRun of the aligned run; appends its clocks to `delays`. If there are any, a signal is no more certain than its timing: its
// change within the standard error of the delays counts as noise. `recorded`: as it was before, whose rows errors name.
RunData PrepareAligned(const runs::MeasuredRun& recorded, AlignedRun aligned, const model::Parameters& given,
                       std::vector<ClockDelay>* delays);

}  // namespace hydro::diagnose
