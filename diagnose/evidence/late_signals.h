// Finds how late the signals of a run are, by Gauss-Newton on the evidence of its balances.
#pragma once

#include <array>
#include <vector>

#include "diagnose/balances/rows.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {

// s: a tile whose first test function is at 0.125 Hz. A shorter run does not fill it.
inline constexpr double kClockTile = 2;

// What may be late: a device with all of its signals, both pressures, or p2 beyond both.
enum class Late { kCommand, kMotor, kArm, kPressures, kP2 };
inline constexpr size_t kLates = 5;
using Delays = std::array<double, kLates>;  // s, by Late

// Lists all signals, each with the delay of its device.
std::vector<runs::SignalDelay> OfSignals(const Delays& delays);

// s; the search considers no larger delay of the run.
double LargestDelay(const runs::MeasuredRun& run);

struct LateSignals {
  double score = 0;  // tempered log evidence of the rows up to 2 Hz, with the odds of each late signal
  std::vector<double> delay, error;  // s, in the order of what may be late; standard errors
};

// Makes all values of the model nearly free, so that a wrong value is not taken for a delay.
void FreeBaseValues(Rows* rows);

// `late` has no duplicates. All values of the model are nearly free. Scores of one run can be compared
// with each other. Throws InputError as PrepareRun does, and ModelError where the model's equations cannot be
// set up.
LateSignals FindLate(const model::ModelDescription& given, const runs::MeasuredRun& run,
                     const std::vector<Late>& late);

}  // namespace hydro::diagnose
