// What is known of free numbers before the runs speak.
#pragma once

#include <vector>

#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

struct Hypothesis;

// What is known of each free parameter beforehand, in the order of Hypothesis::Free(). Each, as fitted (some as
// logarithms), adds weight * (parameter - centre)^2 to the sum that is minimised.
struct Prior {
  std::vector<double> centre, weight;
};

// The base parameters as a model gives them and how well it knows them ([uncertainty], or by kind). Residuals of
// a wrong model are neither white nor of the sensors' size, so that in noise units they would always outweigh
// what is known. `weight` is the part of the sum of squares that a deviation of one standard deviation has to
// gain.
struct Knowledge {
  model::ModelDescription given;
  double weight = 0;
};

// The logarithm of the odds that base values lose by being farther from where they are given than two standard deviations, each: the
// fall of Cauchy's distribution, because a data sheet that says 5 % is now and then wrong altogether. Nearer, only the balances count how
// far, or the same knowledge would be heard twice. Values given as 0 lose nothing.
double OddsLostBy(const model::Parameters& values, const model::ModelDescription& given);

// For the hypothesis' free numbers; all weights are 0 where it has no knowledge. Of a base parameter that is given as
// 0 only its order of magnitude is known.
Prior KnownBefore(const Hypothesis& hypothesis);

}  // namespace hydro::diagnose
