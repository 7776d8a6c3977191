// The friction of motor and pump, T_s and b of eq. (4), from runs with the two sides connected: then dp = 0,
// and at a steady speed T_p = b theta' + T_s sgn(theta').
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/maths/spread.h"
#include "experiments/studies/steady_speed.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::experiments {

struct FrictionPoint {
  SpeedWindow window;
  double torque = 0;  // in-lbf, T_p = k_1 v within +/- T_pmax
  double fitted = 0;  // in-lbf, on the line
  // in-lbf, the largest part of it that inertia can still take: the approach to a steady speed never ends.
  double transient = 0;
};

// Torque regressed on speed, with one Coulomb friction for each direction and one slope for both. The
// intervals are Student's, from the points' scatter about the lines, widened by the most that the remaining
// transients can shift the value: all points lag in the same way, so their scatter does not show it.
struct PumpFriction {
  maths::Estimate T_s;           // in-lbf, mean of the two directions
  maths::Estimate T_s_forward;   // in-lbf
  maths::Estimate T_s_backward;  // in-lbf, a magnitude
  maths::Estimate difference;    // in-lbf, forward minus backward
  maths::Estimate b;             // in-lbf-s
  double scatter = 0;            // in-lbf, standard deviation of the points about the lines
  int degrees_of_freedom = 0;
  std::vector<FrictionPoint> points;
};

// Fits a run with the bypass open; `parameters` gives k_1, T_pmax and J (to judge what is steady). Throws
// InputError, saying what the run has, when the run cannot support the fit: the bypass is closed; neither the
// motor's speed nor its angle was measured; there is no steady speed (the message then says how far from it
// the longest hold is); there are steady speeds in one direction only, fewer than three different ones, or
// fewer than four in all.
PumpFriction FitPumpFriction(const runs::MeasuredRun& run, SpeedSource source,
                             const model::Parameters& parameters);

// The motor's speed if it is measured, else its angle. Throws InputError when neither is.
SpeedSource SpeedSourceOf(const runs::MeasuredRun& run);

struct BreakAway {
  double time = 0;     // s, the first sample that has moved
  double voltage = 0;  // V there
};

// The first sample from `from` to `to` (s) whose motor angle differs by more than `moved` rad from that at
// `from`; none if the motor stays.
std::optional<BreakAway> FindBreakAway(const runs::MeasuredRun& run, double from, double to, double moved);

// How far a torque ramp (in-lbf/s) has risen above friction, in-lbf, when the motor has turned by `moved`:
// from J theta'' = ramp t, theta = ramp t^3 / (6 J).
double BreakAwayExcess(double ramp, double inertia, double moved);

}  // namespace hydro::experiments
