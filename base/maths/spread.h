// How numbers spread, and what they depend on. Infinite numbers are allowed, NaN is not.
#pragma once

#include <vector>

#include "base/maths/estimate.h"

namespace hydro::maths {

// The value that the share `share` (0 to 1) of `sorted` (increasing, not empty) does not exceed; straight
// lines between its numbers.
double Quantile(const std::vector<double>& sorted, double share);

// A share of which `hits` of `count` independent trials tell: Wilson's 95 % interval.
Estimate Share(int hits, int count);

// Spearman's rank correlation of two lists of equal length, -1 to 1: how far y rises with x, in whatever
// curve. Equal numbers share a rank. 0 where either list is constant.
double RankCorrelation(const std::vector<double>& x, const std::vector<double>& y);

// The part of y's variance that goes with x alone, in whatever curve, up or down: the variance of y's means
// over `bins` ranges of x with equally many points each, over y's variance, less what chance gives as many
// bins (Kelley's epsilon squared; it may come out slightly below 0). Where all of y's causes are independent,
// these parts add up to at most 1 (the first-order indices of Sobol). 0 where y is constant.
double MainEffect(const std::vector<double>& x, const std::vector<double>& y, int bins);

}  // namespace hydro::maths
