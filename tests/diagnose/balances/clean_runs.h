// Runs without noise, of exact simulation: what columns of balances are compared with.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/terms/description.h"

namespace hydro::testing {

// How a run is made.
struct CleanRun {
  std::string name;
  model::Shaft shaft = model::Shaft::kClamped;
  double arm_angle = 0;
  bool bypass = false;
  double pressure = 100;                     // psi, of both sides at the start
  std::vector<double> levels = {};           // V, each for `level_time`
  double level_time = 0.1;                   // s
  double sine = 0, frequency = 0, turn = 0;  // V, Hz, Hz/s: a chirp on top
  double duration = 2;                       // s
};

// Table 1 with a quarter of its friction: where friction turns within the smoothing of signals, no balance is
// better than that.
model::ModelDescription PlainMachine(std::vector<model::EffectDescription> effects = {});

// A clamped run at pressures far above the charge, one that is held by the valves half the time, a free arm,
// the bypass, and the bypass at speeds at which friction turns. Levels of the command are well below or well
// above what saturates the motor.
std::vector<CleanRun> RichRuns();

// Simulated at 2 kHz, with sensors that are all but perfect. Throws ModelError as Actuator does.
runs::MeasuredRun Measure(const model::ModelDescription& truth, const CleanRun& how);
// Of all rich runs but those in which friction holds the pump all the time.
std::vector<runs::MeasuredRun> MeasureAll(const model::ModelDescription& truth);
// Prepared as the gap finder does it, for a model of these parameters.
std::vector<diagnose::RunData> Prepared(std::vector<runs::MeasuredRun> runs, const model::Parameters& given);

}  // namespace hydro::testing
