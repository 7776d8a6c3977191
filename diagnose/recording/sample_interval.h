// How far apart a recording's samples are.
#pragma once

#include <vector>

namespace hydro::diagnose {

// s between samples. No recorder of such a machine is faster.
inline constexpr double kFastestSamples = 5e-6;

// The median time between successive samples, s; 1 when there are fewer than two.
double MedianInterval(const std::vector<double>& time);
// The same over several recordings together.
double MedianInterval(const std::vector<const std::vector<double>*>& times);

}  // namespace hydro::diagnose
