// How far apart a recording's samples are.
#pragma once

#include <string>
#include <vector>

namespace hydro::diagnose {

// s between samples. Slower recorders do not show the motion of such a machine.
inline constexpr double kSlowestSamples = 0.25;

// The median time between successive samples, s; 1 when there are fewer than two.
double MedianInterval(const std::vector<double>& time);
// The same over several recordings together.
double MedianInterval(const std::vector<const std::vector<double>*>& times);

// Suggests to a person which unit a time column may have if its samples are `interval` seconds apart: " (is
// the column in us? unit = \"us\")". Empty where no unit gives an interval that suits such a machine.
std::string TimeUnitHint(double interval);

}  // namespace hydro::diagnose
