// Whether one fit is better than another, given that residuals are not independent.
#pragma once

#include <vector>

#include "diagnose/fit/fit.h"
#include "diagnose/fit/held_out.h"

namespace hydro::diagnose {

// Sums of squared residuals over stretches of time long enough to be nearly independent, run after run.
struct BlockSums {
  std::vector<double> sums;
  double count = 0;  // total number of residuals
};
BlockSums BlocksOf(const std::vector<const RunData*>& runs, const HeldOut& predicted);
// The logarithms of the squared gaps, a run each: for windows.
BlockSums LogarithmsOf(const HeldOut& predicted);

// The total excess of `worse` over `better`, divided by its standard error from the scatter of the blocks.
// Both must have the same blocks.
double TValue(const BlockSums& worse, const BlockSums& better);

// The least gain required of a change on data that was not fitted. Calibrated on rigs of bench/gap_score
// (seed 1): spurious changes took up to a fifth of the excess that small effects outside the catalogue leave;
// true ones of two noise units or more took more than half.
inline constexpr double kLeastGain = 0.1;    // of the squared gap
inline constexpr double kLeastShare = 0.25;  // of the squared gap above the noise floor
double LeastMaterialGain(double squared_gap_before);
bool Material(double squared_gap_before, double squared_gap_after);

// Whether the remaining gap needs no further explanation: it is at most 1.15 times the noise. Where all
// sensors are exact (noise below 2e-4 of their range, as in a simulation), no model of a rig comes that near;
// then the gap is closed when 1 % of the squared gap above the noise is left.
bool Closed(double squared_gap_before, double squared_gap_after, bool exact_sensors);
bool ExactSensors(const std::vector<const RunData*>& runs);

// The probability that chance alone improves a fit by `fall` (of a sum of squared residuals whose remaining
// mean is `squared_gap`) with `parameters` more free, when the best of `tried` is picked and only one in
// `correlation` residuals is independent.
double PValue(double fall, double squared_gap, double correlation, size_t parameters, size_t tried);

// The number of successive residuals that count as one: the integrated autocorrelation, averaged over the
// signals. Of runs that can be simulated.
double CorrelationOf(const std::vector<const RunData*>& runs, const Fitted& fitted);

}  // namespace hydro::diagnose
