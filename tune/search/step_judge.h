// Judges how fast gains are on the nonlinear model: over sizes of steps, over the arm's travel, and over the
// model's uncertainty.
#pragma once

#include <vector>

#include "settings/stack_config.h"
#include "tune/search/gains.h"
#include "tune/search/goals.h"
#include "tune/search/step_trial.h"

namespace hydro::tune {

// A trial lasts this many times the shortest settling time. A ratio of this or more means that the arm never
// settled.
inline constexpr double kNeverSettled = 2.5;
// Added to the ratio where a limit would have ended the run, or where the arm ran into its stop.
inline constexpr double kStopped = 10;

// One step that is tried.
struct StepCase {
  size_t model = 0;     // 0: as its file says; otherwise a sample from its uncertainty
  double start = 0;     // rad
  double step = 0;      // rad, signed
  double shortest = 0;  // s: FastestSettling of this model
};

struct StepResult {
  double ratio =
      0;  // settling time (2 %) over the shortest; what never settled counts its whole time and its error
  bool settled = false;
  double settling = 0;           // s
  double overshoot_percent = 0;  // of the step
  double error = 0;              // rad, at the end
  double saturated = 0;          // s, with the motor at its torque limit
};

struct StepVerdict {
  double ratio = 0;                // the largest with the model as it is, over steps and travel
  double uncertain_ratio = 0;      // the largest over the samples of the model
  double overshoot_percent = 0;    // the largest with the model as it is
  double settling = 0;             // s: the longest of the goal's step with the model as it is
  StepCase slowest;                // the case with the largest ratio of these
  StepCase uncertain_slowest;      // and of the samples
  double unsettled = 0;            // share of the cases with the model as it is that never settle
  double uncertain_unsettled = 0;  // and with the samples of the model
  double score() const;            // smaller is better
};

struct JudgeSettings {
  Goals goals = {};
  int samples = 8;     // drawn from the model's uncertainty
  bool noise = false;  // with the configuration's sensor noise, or with a usual one if it has none
};

class StepJudge {
 public:
  StepJudge(settings::StackConfig config, const JudgeSettings& settings);

  // rad, the steps that are tried, from the shortest to the longest.
  const std::vector<double>& steps() const { return steps_; }
  // The step to which a goal of settling time refers: that of the goal, or 0.1 rad of the paper's travel.
  double goal_step() const { return goal_step_; }
  const settings::StackConfig& config() const { return config_; }
  const std::vector<model::ModelDescription>& models() const { return models_; }

  // Judges gains for the model as its file says, on all cases.
  StepVerdict Judge(const Gains& gains) const;
  // Tries one case and returns its motion (the angle from its start on), for tables and pictures.
  StepResult Try(const Gains& gains, const StepCase& step, StepRun* run = nullptr) const;
  // The step from mid-stroke on the model as its file says.
  StepCase Nominal(double step) const;

 private:
  StepTrial Trial(const Gains& gains, const StepCase& step) const;
  void AddCases();

  settings::StackConfig config_;
  std::vector<double> steps_;
  double goal_step_ = 0;
  std::vector<model::ModelDescription> models_;
  std::vector<StepCase> cases_;
};

}  // namespace hydro::tune
