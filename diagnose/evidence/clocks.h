// Recordings whose channels were sampled by devices with separate clocks: the balances themselves show how
// late each clock is.
#pragma once

#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// s: shorter delays have names among the catalogue's effects of amplifier and sensors.
inline constexpr double kLeastDelay = 0.02;

// Estimates the recording's clocks relative to that of p1 and p2 (a common shift cannot be seen) and shifts
// its signals to that clock (RemoveDelays of runs/measured/sample_times.h). In the balances a clock is the
// column of a late signal with a wide prior. Its delay is found by Gauss-Newton on their evidence, first on
// rows up to 0.25 Hz, where a large delay is a small change, and finally on rows up to 2 Hz. All values of
// the model are nearly free there, so that a wrong value is not taken for a delay (late_signals.h).
//
// A late command and motor count as another clock when both are late by at least 20 ms and by at least two
// samples, and when this is likelier than a delay of that one signal or of the pressures alone. The catalogue
// of effects has names for those delays, and for smaller ones. Otherwise the run stays unchanged to the bit
// and the result is empty.
std::vector<ClockDelay> AlignClocks(const model::ModelDescription& given, runs::MeasuredRun* run);

// A run with all signals on one clock, and the clocks that were found.
struct AlignedRun {
  runs::MeasuredRun run;
  std::vector<ClockDelay> clocks;
};
// Aligns each run by AlignClocks(). The result is the same for any number of jobs.
std::vector<AlignedRun> AlignedRuns(const model::ModelDescription& given,
                                    const std::vector<runs::MeasuredRun>& runs, int jobs);

// Calls PrepareRun for the aligned run and appends its clocks to `delays`. If there are any, a signal is no
// more certain than its timing: the change within the standard error of the delays counts as noise.
// `recorded` is the run before alignment; errors name its rows.
RunData PrepareAligned(const runs::MeasuredRun& recorded, AlignedRun aligned,
                       const model::ModelDescription& given, std::vector<ClockDelay>* delays);

}  // namespace hydro::diagnose
