// Whether one fit is better than another, given that residuals are not independent.
#pragma once

#include <vector>

#include "diagnose/fit/fit.h"
#include "diagnose/fit/held_out.h"

namespace hydro::diagnose {

// Sums of squared residuals over stretches of time long enough to be nearly independent, run after run.
struct BlockSums {
  std::vector<double> sums;
  double count = 0;  // of residuals in all
};
BlockSums BlocksOf(const std::vector<const RunData*>& runs, const HeldOut& predicted);

// How much larger `worse` is, all in all, over the standard error that the blocks' scatter gives; of the same
// blocks.
double TValue(const BlockSums& worse, const BlockSums& better);

// What a change must gain on data that was not fitted. Set on rigs of bench/gap_score (seed 1), where
// spurious changes took up to a fifth of the excess that small effects outside the catalogue leave, and true
// ones of two noise units and more took more than half.
inline constexpr double kLeastGain = 0.1;    // of the squared gap
inline constexpr double kLeastShare = 0.25;  // of the squared gap above the noise floor

bool Material(double squared_gap_before, double squared_gap_after);

// Whether what is left of a gap needs no further explanation: it is within 1.15 of the noise. Where all
// sensors are exact (noise below 2e-4 of their range: a simulation's) no model of a rig comes that near;
// there it is closed when 1 % of the squared gap above the noise is left.
bool Closed(double squared_gap_before, double squared_gap_after, bool exact_sensors);
bool ExactSensors(const std::vector<const RunData*>& runs);

// That chance alone makes a fit better by `fall` (of a sum of squared residuals whose remaining mean is
// `squared_gap`) with `parameters` more free, when the best of `tried` is looked at and only one in
// `correlation` residuals is independent.
double PValue(double fall, double squared_gap, double correlation, size_t parameters, size_t tried);

// How many successive residuals count as one: the integrated autocorrelation of each signal, averaged.
double CorrelationOf(const std::vector<const RunData*>& runs, const Fitted& fitted);

}  // namespace hydro::diagnose
