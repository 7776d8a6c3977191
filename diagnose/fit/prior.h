// What is known of free numbers before the runs are seen.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

struct Hypothesis;

// What is known beforehand of each free parameter, in the order of Hypothesis::Free(). Each parameter, as
// fitted (some as logarithms), adds weight * (parameter - centre)^2 to the sum that is minimised.
struct Prior {
  std::vector<double> centre, weight;
};

// The base parameters as a model gives them, and how well it knows them ([uncertainty], or by kind). The
// residuals of a wrong model are neither white nor of the sensors' size, so that in noise units they would
// always outweigh prior knowledge. `weight` is the part of the sum of squares that a deviation of one
// standard deviation has to gain.
struct Knowledge {
  model::ModelDescription given;
  double weight = 0;
};

// What the balances of the fitted runs say of base values.
struct MeasuredValues {
  model::Parameters values;
  // By places in BaseParameters(): the standard deviation of the value's logarithm, or of the value where 0
  // was given. Values without an entry were not measured.
  std::map<size_t, double> deviation;
};

// Minus the logarithm of how likely a value is that lies so many standard deviations from the given one, by
// Cauchy's distribution: a data sheet that says 5 % is sometimes wrong altogether.
double CostOfLying(double deviations);

// How well a model knows a number of an effect that it states, as the number's standard deviation. The two
// sides of a cylinder or a pump are known as their mean is, a phase to a tenth of a radian; all else is an
// estimate, as friction and leakage are. 0: a count, or a number that is stated as 0.
double DeviationOf(const model::ModelDescription& given, const model::EffectParameter& number);

// Whether these runs measure all torques by this value, so that they do not show it: k_1 in a bare motor, the
// inertia where nothing is ever commanded.
bool IsYardstick(double model::Parameters::*member, const std::vector<const RunData*>& runs);

// The prior for the hypothesis' free numbers. All weights are 0 where the hypothesis has no knowledge. For a
// base parameter that is given as 0, only the order of magnitude is known. Numbers of an effect that was
// found are not known at all.
Prior KnownBefore(const Hypothesis& hypothesis);

// The same for a fit to windows, with what the balances measured. They saw all of the runs, a fit sees few
// windows, and where a model lacks something, a window is hardly a measurement of any value. What is wrong
// with a model is alike in all rows, so the balances' squares count by a kTemperature-th only.
Prior KnownToAFit(const Hypothesis& hypothesis);

}  // namespace hydro::diagnose
