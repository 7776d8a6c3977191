// How far apart a recording's samples are.
#pragma once

#include <string>
#include <vector>

namespace hydro::diagnose {

// s between samples: slower recorders do not show the motion of such a machine.
inline constexpr double kSlowestSamples = 0.25;

// The median time between successive samples, s; 1 when there are fewer than two.
double MedianInterval(const std::vector<double>& time);
// The same over several recordings together.
double MedianInterval(const std::vector<const std::vector<double>*>& times);

// What a time column whose samples are that many s apart may be in, for a person: " (is the column in us? unit =
// \"us\")"; empty where no unit makes them those of such a machine.
std::string TimeUnitHint(double interval);

}  // namespace hydro::diagnose
