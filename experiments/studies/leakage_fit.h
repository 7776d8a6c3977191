// The leakage coefficients c_E and c_I of eqs. (11), (12) from runs with a clamped shaft: the model is
// simulated under the measured voltages, and both are adjusted until the pressures agree. What the paper did
// by hand.
#pragma once

#include <string>
#include <vector>

#include "maths/estimate.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::experiments {

// How well some of the measurements tell c_E and c_I.
struct LeakageInformation {
  double c_E_error = 0;  // standard errors, relative to the value; infinite where nothing tells it
  double c_I_error = 0;
  double correlation = 0;  // of the two errors
  // The combination c_E + c_I_weight c_I is what the measurements tell best, with this relative error.
  double c_I_weight = 0;
  double combination_error = 0;
};

// The pressures that the model gives at a run's samples, and the motor's speed.
struct SimulatedRun {
  std::vector<double> p1, p2, motor_speed;
};

// A parameter that was taken as known: by how many percent c_E and c_I change when it is 1 % larger.
struct LeakageShift {
  std::string parameter;
  double c_E_percent = 0;
  double c_I_percent = 0;
};

struct LeakageFit {
  maths::Estimate c_E;             // in^3/(s psi); intervals take all other parameters as known
  maths::Estimate c_I;             // in^3/(s psi)
  maths::Estimate combination;     // in^3/(s psi), c_E + information.c_I_weight c_I
  LeakageInformation information;  // of all measurements
  // Of parts: while both sides are above p_3 and while a valve holds one there, by p_1 and p_2 or by p_2 -
  // p_1 only.
  LeakageInformation floating, held, floating_difference, held_difference, all_difference;
  std::vector<std::string> not_identifiable;  // those of "c_E", "c_I" whose interval is wider than +/- 25 %
  double rms = 0;                             // of the residuals, each in its noise's standard deviations
  bool converged = false;
  std::vector<LeakageShift> shifts;
  std::vector<SimulatedRun> simulated;     // of each run, with the values found
  std::vector<double> p1_noise, p2_noise;  // psi, of each run: as given, or estimated from the differences
};

// The model clamped at the run's angle, under its voltage, from rest with both pressures at `pressure`.
SimulatedRun SimulateClamped(const model::ModelDescription& model, const runs::MeasuredRun& run,
                             double pressure);

// Fits both coefficients to all runs by Levenberg-Marquardt on their logarithms; the model's own are not
// used. Throws InputError where a run cannot support it, saying what it has: shaft not clamped, bypass open,
// p1 or p2 not measured, a start that is not at rest with equal pressures, a torque that never exceeds T_s,
// pressures that hardly move.
LeakageFit FitLeakage(const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::experiments
