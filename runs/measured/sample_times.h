// When samples were taken: channels that were recorded late are aligned, and samples too far apart are
// refused.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runs/measured/measured_run.h"

namespace hydro::runs {

// A signal of a run and its delay in s, which is negative when it was recorded early.
using SignalDelay = std::pair<MeasuredSignal MeasuredRun::*, double>;

// Replaces each sample by the one `delay` later, rounded to the nearest sample, so that values and their
// noise stay as recorded. Cuts off samples at the ends that have no such reading. Returns false, and leaves
// the run unchanged, when fewer than two samples would remain.
bool RemoveDelays(const std::vector<SignalDelay>& delays, MeasuredRun* run);

// The median time between successive samples, s; 1 when there are fewer than two.
double MedianInterval(const std::vector<double>& time);
// The same over several recordings together.
double MedianInterval(const std::vector<const std::vector<double>*>& times);

// s between samples. No recorder of such a machine is faster.
inline constexpr double kFastestSamples = 5e-6;
// s between samples. Slower recorders do not show the motion of such a machine.
inline constexpr double kSlowestSamples = 0.25;

// The unit in which a time column may be whose samples are `interval` s apart when it is read in units of
// `scale` s, as a text for people: " (is the column in us? unit = \"us\")". Empty where the samples fit such
// a machine as they stand; a question without a unit where they fit in none.
std::string TimeUnitHint(double interval, double scale);

// Throws InputError, with that hint, when half of the run's samples are farther apart than kSlowestSamples or
// closer together than kFastestSamples.
void RequirePossibleSamples(const MeasuredRun& run);

}  // namespace hydro::runs
