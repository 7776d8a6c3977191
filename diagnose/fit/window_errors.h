// How well several windows of a recording are predicted together.
#pragma once

#include <vector>

#include "diagnose/fit/check_windows.h"

namespace hydro::diagnose {

// How badly the median window is predicted: the logarithms of its signals' squared errors, added up.
double MedianBadness(const std::vector<PredictionErrors>& windows);

// The median fall of a window's badness, over the signals that `to` has.
double Gain(const std::vector<PredictionErrors>& from, const std::vector<PredictionErrors>& to);

}  // namespace hydro::diagnose
