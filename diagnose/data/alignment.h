// Recordings whose channels were sampled by devices with clocks of their own: how late each is.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/run_data.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// A clock of a recording, against that of p1 and p2.
struct ClockDelay {
  std::string run;
  std::vector<std::string> signals;  // recorded by that clock
  double delay = 0;                  // s, by which they are late; early: below 0
  double error = 0;                  // half the width of the 95 % interval, s
};

// Estimates the clocks of a recording, and puts all of its signals on that of the pressures (RemoveDelays of
// runs/run_delays.h). The torque balance, eq. (4), k_1 v = D (p2 - p1) + J theta'' + b theta' + (T_s + f
// (p1 + p2)) sgn(theta'), holds for the measured signals only when they are shifted right; its coefficients
// are free, so that it does not matter what the model has for them. With a driven shaft the flow, eqs. (13)
// and (14), does the same for the arm.
//
// Lateness of one channel, of the command, and pressures that lag have names in the catalogue of effects and
// are left to the search. So are delays below 20 ms or two samples: here it takes speed and command that are
// both late, a balance that no shift of one of them alone comes near, and the same delay in every part of the
// run. Otherwise the run is left as it is, to the bit, and nothing is returned.
std::vector<ClockDelay> AlignClocks(const model::Parameters& model, runs::MeasuredRun* run);

// PrepareRun on one clock; what was found of clocks is added to `delays`. Where it was anything, a signal is
// no surer than its time: what it changes within the standard error of the delays counts as noise.
RunData PrepareAligned(runs::MeasuredRun run, const model::Parameters& model,
                       std::vector<ClockDelay>* delays);

// "run sine: motor_speed is late by 0.334 +- 0.013 s against p1 and p2"
std::string Says(const ClockDelay& delay);

}  // namespace hydro::diagnose
