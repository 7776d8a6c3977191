// The position loop's design: its numbers as text and JSON, and the search for gains of the retuned loop.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runs/step_response.h"
#include "tune/design/bang_bang.h"
#include "tune/design/position_design.h"
#include "tune/search/step_trial.h"

namespace hydro::experiments {

// Poles and settling times as text and JSON, for the figures of the position loop's design.
inline constexpr double kPaperGain = 350;  // psi s/rad, g of the paper's Figure 10

// [[re, im], ...]
std::vector<std::pair<double, double>> AsPairs(const std::vector<design::Complex>& poles);

// The pole with the largest real part; of a pair, the upper one.
design::Complex SlowestPole(const std::vector<design::Complex>& poles);

// "0.312 s", or "never".
std::string SettlingText(const runs::StepResponse& response);

// "-38.4 ± 113.1j", or "-2.52" for a real pole.
std::string PoleText(const design::Complex& pole);

// The search for position-loop gains that bring the arm to its target as fast as the motor can.

// A step of `step` rad with a stack's configuration (whole TOML) and model (TOML): gains, rates, limits.
// Features that a StepTrial lacks (noise, quantisation) are left out.
tune::StepTrial TrialOf(const std::string& config, const std::string& model, double step);

struct Candidate {
  double c1 = 0;  // psi/rad
  double c2 = 0;  // psi s/rad
  // The largest ratio, over the steps tried, of the settling time (2 %) to the shortest possible one;
  // infinity when the arm does not settle within twice that time.
  double worst_ratio = 0;
};

// Tries every c1 of 8000, 10000 ... 20000 psi/rad with every multiple c2 of 50 psi s/rad for which c1/c2 lies
// between 6 and 16 1/s, on steps of 0.9, 1 and 1.1 times trial.step, so that the result does not depend on
// the length of one step. (Below 8000 psi/rad, friction alone may leave an error of more than 1 % of 0.1
// rad.) Best first; among equals, smaller gains first.
std::vector<Candidate> SearchGains(tune::StepTrial trial, const design::RigidDrive& drive);

}  // namespace hydro::experiments
