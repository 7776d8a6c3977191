// The search for the position loop's gains that bring the arm to its target as fast as the motor can.
#pragma once

#include <string>
#include <vector>

#include "experiments/maths/bang_bang.h"
#include "experiments/runs/step_trial.h"

namespace hydro::experiments {

// What a stack's configuration (whole TOML) and model (TOML) make of a step of `step` rad: gains, rates,
// limits. The parts of it that a StepTrial does not know (noise, quantisation) are left out.
StepTrial TrialOf(const std::string& config, const std::string& model, double step);

struct Candidate {
  double c1 = 0;  // psi/rad
  double c2 = 0;  // psi s/rad
  // The largest ratio, over the steps tried, of the settling time (2 %) to the shortest possible one;
  // infinity when it does not settle within twice that time.
  double worst_ratio = 0;
};

// Tries every c1 of 8000, 10000 ... 20000 psi/rad with every c2 of a multiple of 50 psi s/rad for which c1/c2
// lies between 6 and 16 1/s, on steps of 0.9, 1 and 1.1 times trial.step, so that the result does not hang on
// one step's length. (Below 8000 psi/rad friction alone may leave an error of more than 1 % of 0.1 rad.)
// The best first; of equals the one with the smaller gains.
std::vector<Candidate> SearchGains(StepTrial trial, const RigidDrive& drive);

}  // namespace hydro::experiments
