// Figure 10's retuned step on machines that Table 1 allows: gains for Table 1, and plants drawn from its
// uncertainty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/maths/spread.h"
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

// Statistics of the steps of drawn machines: how they spread, on which parameters that depends, and which
// machines are worst.
inline constexpr double kMuchOvershoot = 5;  // % of the step

// One quantity over all machines. It is infinite where that many machines never settle.
struct Spread {
  double known = 0;  // for the model as its file says
  double lowest = 0, p5 = 0, p50 = 0, p95 = 0, p99 = 0, highest = 0;
};

// The influence of one base parameter on the spread.
struct Influence {
  size_t base = 0;                // in BaseParameters()
  double standard_deviation = 0;  // relative
  // maths::RankCorrelation and maths::MainEffect. A machine that never settles counts with the duration of
  // the whole run.
  double settling_correlation = 0, settling_effect = 0;
  double overshoot_correlation = 0, overshoot_effect = 0;
};

// The machines whose most influential parameter is close to the model's value.
struct Nearly {
  size_t base = 0;
  double within = 0;  // relative
  int count = 0;
  double settling_p50 = 0, settling_p95 = 0;  // s
  double overshoot_p95 = 0;                   // %
};

struct UncertainSpread {
  Spread settling, shortest, ratio;  // s, s, settling over shortest
  Spread overshoot;                  // %
  Spread error;                      // rad, magnitude
  Spread saturated;                  // s
  maths::Estimate never,
      overshoots;  // shares of the machines: never settle; overshoot by more than kMuchOvershoot
  // The largest share of machines that friction can keep from settling: those on which the pump's friction
  // can hold the arm outside 2 % of the step, in closed form from T_s, k_1 and D dp of the known model.
  double friction_holds = 0;
  std::vector<Influence> influences;  // largest settling_effect first, without parameters that are 0
  Nearly nearly;
  // Numbers of the machines that settle last. Those that never settle come first.
  std::vector<size_t> slowest;
  std::vector<size_t> most_overshoot;
};

UncertainSpread SpreadOf(const UncertainSteps& steps);

}  // namespace hydro::experiments
