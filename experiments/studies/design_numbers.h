// Poles and settling times as text and JSON, for the figures of the position loop's design.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runs/step_response.h"
#include "tune/design/position_design.h"

namespace hydro::experiments {

inline constexpr double kPaperGain = 350;  // psi s/rad, g of the paper's Figure 10

// [[re, im], ...]
std::vector<std::pair<double, double>> AsPairs(const std::vector<design::Complex>& poles);

// The pole with the largest real part; of a pair, the upper one.
design::Complex SlowestPole(const std::vector<design::Complex>& poles);

// "0.312 s", or "never".
std::string SettlingText(const runs::StepResponse& response);

// "-38.4 ± 113.1j", or "-2.52" for a real pole.
std::string PoleText(const design::Complex& pole);

}  // namespace hydro::experiments
