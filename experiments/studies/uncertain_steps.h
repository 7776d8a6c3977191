// Figure 10's retuned step on machines that Table 1 allows: gains for Table 1, and plants drawn from its
// uncertainty.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tune/search/step_trial.h"

namespace hydro::experiments {

// The step of one machine.
struct UncertainStep {
  model::Parameters parameters;  // the machine's
  double shortest = 0;           // s, the shortest settling time that its motor allows
  double settling = 0;           // s, until the arm stays within 2 % of the step; NaN: not within the run
  double overshoot_percent = 0;  // of the step
  double final_error = 0;        // rad, arm minus reference, mean of the last 0.1 s
  double saturated = 0;          // s, with the motor at its torque limit
  double highest_pressure = 0;   // psi, of either side
  double highest_speed = 0;      // rad/s, of the motor

  bool settles() const { return settling == settling; }
};

struct UncertainSteps {
  tune::StepTrial trial;  // of the model as its file says; for the others only the model differs
  uint64_t seed = 1;
  UncertainStep known;
  std::vector<UncertainStep> drawn;  // number i is model::DrawnModel(trial.model, seed, i)
};

// config/retuned.toml's loop on Table 1 with a step of `step` rad, observed for `duration` s. A shipped
// configuration defines everything else.
tune::StepTrial RetunedTrial(double step, double duration);

// The step on one machine. Throws ModelError, also when the arm runs into its stop.
UncertainStep StepOf(tune::StepTrial trial, const model::ModelDescription& machine);

// Steps of `count` drawn machines, on up to `jobs` threads. The result does not depend on the number of
// threads.
UncertainSteps StepDrawnModels(const tune::StepTrial& trial, int count, uint64_t seed, int jobs,
                               const std::function<void(double)>& progress);

}  // namespace hydro::experiments
