// Recordings whose channels were sampled by devices with separate clocks: estimates how late each clock is.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/run_data.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// A clock of a recording, relative to that of p1 and p2.
struct ClockDelay {
  std::string run;
  std::vector<std::string> signals;  // recorded by that clock
  double delay = 0;                  // s; negative: early
  double error = 0;                  // half the width of the 95 % interval, s
};

// Estimates the clocks of a recording and shifts all of its signals to the clock of the pressures
// (RemoveDelays of runs/run_delays.h). The torque balance, eq. (4), k_1 v = D (p2 - p1) + J theta'' + b
// theta' + (T_s + f (p1 + p2)) sgn(theta'), holds for the measured signals only when they are shifted
// correctly. Its coefficients are free, so the model's values for them do not matter. With a driven shaft,
// the flow, eqs. (13) and (14), does the same for the arm.
//
// A delay of a single channel, a delay of the command, and lagging pressures have names in the catalogue of
// effects and are left to the search. So are delays below 20 ms or two samples. A correction needs speed and
// command that are both late, a balance that no shift of one of them alone comes near, and the same delay in
// every part of the run. Otherwise the run stays unchanged to the bit and the result is empty.
std::vector<ClockDelay> AlignClocks(const model::Parameters& model, runs::MeasuredRun* run);

// PrepareRun with all signals on one clock; appends the clocks found to `delays`. If there are any, a signal
// is no more certain than its timing: its change within the standard error of the delays counts as noise.
RunData PrepareAligned(runs::MeasuredRun run, const model::Parameters& model,
                       std::vector<ClockDelay>* delays);

// "run sine: motor_speed is late by 0.334 +- 0.013 s relative to p1 and p2"
std::string DelayRemark(const ClockDelay& delay);

}  // namespace hydro::diagnose
