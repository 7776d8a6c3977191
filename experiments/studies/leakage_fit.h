// The leakage coefficients c_E and c_I of eqs. (11), (12), from runs with a clamped shaft. The fit simulates
// the model under the measured voltages and adjusts both coefficients until the pressures agree; the paper
// did this by hand.
#pragma once

#include <string>
#include <vector>

#include "base/maths/spread.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::experiments {

// How well a set of measurements determines c_E and c_I.
struct LeakageInformation {
  double c_E_error = 0;  // standard errors relative to the value; infinite if undetermined
  double c_I_error = 0;
  double correlation = 0;  // between the two errors
  // The measurements determine the combination c_E + c_I_weight c_I best, with this relative error.
  double c_I_weight = 0;
  double combination_error = 0;
};

// The model's pressures and motor speed at a run's samples.
struct SimulatedRun {
  std::vector<double> p1, p2, motor_speed;  // psi, psi, rad/s
};

// A parameter that the fit takes as known: how many percent c_E and c_I change when it is 1 % larger.
struct LeakageShift {
  std::string parameter;
  double c_E_percent = 0;
  double c_I_percent = 0;
};

struct LeakageFit {
  maths::Estimate c_E;             // in^3/(s psi); the interval takes all other parameters as known
  maths::Estimate c_I;             // in^3/(s psi)
  maths::Estimate combination;     // in^3/(s psi), c_E + information.c_I_weight c_I
  LeakageInformation information;  // from all measurements
  // The same from parts of the measurements: while both sides are above p_3, and while a valve holds one side
  // there; from p_1 and p_2, or from p_2 - p_1 only.
  LeakageInformation floating, held, floating_difference, held_difference, all_difference;
  std::vector<std::string> not_identifiable;  // "c_E", "c_I" if the interval is wider than +/- 25 %
  double rms = 0;                             // of the residuals, in standard deviations of the noise
  bool converged = false;
  std::vector<LeakageShift> shifts;
  std::vector<SimulatedRun> simulated;     // of each run, with the fitted values
  std::vector<double> p1_noise, p2_noise;  // psi, of each run; given, or estimated from differences
};

// Here and below, runs are in the paper's units, and the model is in its own (paper_units.h).

// The model clamped at the run's angle, under the run's voltage, from rest with both pressures at `pressure`
// (psi; NaN: the model's p_3).
SimulatedRun SimulateClamped(const model::ModelDescription& model, const runs::MeasuredRun& run,
                             double pressure);

// Fits both coefficients to all runs by Levenberg-Marquardt on their logarithms; the model's own values are
// not used. Throws InputError, saying what the run has, when a run cannot support the fit: shaft not clamped,
// bypass open, p1 or p2 not measured, a start that is not at rest with equal pressures, a torque that never
// exceeds T_s, pressures that hardly move.
LeakageFit FitLeakage(const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs);

}  // namespace hydro::experiments
