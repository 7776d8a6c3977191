// The runs that Figure 10 compares: steps of the arm in the linear design model and in the full model, the
// full model with single causes of the difference switched off, and the retuned loop against the motor's
// limits.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/studies/experiment.h"
#include "runs/step_response.h"
#include "tune/design/bang_bang.h"
#include "tune/design/position_design.h"
#include "tune/design/sampled_position_loop.h"
#include "tune/search/step_trial.h"

namespace hydro::experiments {

inline constexpr double kFigure10Step = 0.1;        // rad; the paper prints none
inline constexpr double kFigure10Interval = 0.001;  // s; the paper prints none

// The arm in one run of the stack, starting at the step.
struct ArmRun {
  std::vector<double> time, angle, torque, speed;  // s, rad, in-lbf, rad/s of the motor
  runs::StepResponse response;
  double saturated_time = 0;  // s
  double highest_speed = 0;   // rad/s
};

// Runs a stack (a whole configuration, which steps the arm's reference from 0 to `step`, rad) on a model.
// Throws std::runtime_error when the reference never steps, and what the runner throws.
ArmRun RunArm(const StackRunner& run_stack, const std::string& name, const std::string& config,
              const model::ModelDescription& model, double step);

// The figure with one form of the derivative.
struct FormRuns {
  design::Response linear;
  runs::StepResponse linear_step;
  ArmRun nonlinear;
};

// The full model with some of those effects switched off that the linear model lacks.
struct Cause {
  const char* key;
  const char* label;                                    // in the figure's key
  bool friction, saturation, speed_coupling, arm_flow;  // effects that stay on
};
enum CauseIndex {
  kAllOn,
  kNoFriction,
  kNoSaturation,
  kNoFrictionNoSaturation,
  kFeedforward,
  kFeedforwardNoFrictionNoSaturation,
  kNoArmFlow,
  kCauseCount
};
extern const std::array<Cause, kCauseCount> kCauses;

struct CauseRuns {
  std::array<ArmRun, kCauseCount> runs;
  runs::StepResponse exact;           // the exact linearisation
  runs::StepResponse exact_assisted;  // with arm-speed feed-forward
  double friction_error = 0;          // rad, band in which the pump's friction holds the arm
};

// A step of the retuned loop.
struct RetunedStep {
  std::string label;  // in the figure's key
  double step;        // rad
  bool gravity, noise;
  ArmRun run;
  double shortest;  // s, shortest settling time that the motor's limits allow
};

struct RetunedRuns {
  design::RigidDrive drive;
  design::FastestMove fastest;
  double shortest = 0;           // s, shortest settling time
  tune::StepTrial shipped;       // config/retuned.toml
  bool shipped_is_best = false;  // a repeated search finds the shipped gains
  ArmRun run;
  double ratio = 0;  // settling time over the shortest
  std::vector<RetunedStep> steps;
  double worst_ratio = 0;     // over the steps without gravity
  double expected_error = 0;  // rad, holds the arm against gravity after the last step; closed form
};

struct Figure10Runs {
  model::ModelDescription model;
  design::DesignModel design;
  double c1 = 0, c2 = 0;          // psi/rad, psi s/rad
  std::array<FormRuns, 2> forms;  // derivative on the error (as printed) and on the measurement
  double form_difference = 0;     // rad, largest difference between the two in the full model
  CauseRuns causes;               // derivative on the measurement
  RetunedRuns retuned;
};

Figure10Runs RunFigure10(const ExperimentOptions& options);

}  // namespace hydro::experiments
