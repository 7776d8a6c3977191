// Numbers that are too large or too small by a factor that no known unit has: a gear, a divider, another sensor.
#pragma once

#include <vector>

#include "diagnose/data/recording_mistake.h"
#include "diagnose/data/signal_balances.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// For each kind of signal the factor with which the balances close best; none below 2, where a wrong value of the model
// is likelier.
std::vector<RecordingMistake> UnknownFactors(const SignalBalances& balances, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
