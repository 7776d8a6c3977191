// The closed oil between motor and shaft as a spring that the motor's torque meets: what a recording shows of it, with pressures or without.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "model/terms/terms.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

struct OilSpring {
  double stiffness = 0, error = 0;     // of the closed oil's
  double left = 1, left_without = 1;   // of the squared torque: with the spring, and without
  double inertia = 1;                  // of the model's
  double would_take = 0, at_most = 0;  // of the torque, by closed oil: where it is fast, and at any speed
  double follows = 0, volume = 0;      // the arm's correlation with the motor, and the ratio of their volumes
  double moved = 0;                    // the volume that the arm displaced in all, by the motor's
};

// From the command, the motor's motion and, where the shaft is not clamped, the arm's. Empty where the run is too short or too slow for it.
// The run has the motor's speed or angle and, unless it is clamped, the arm's.
std::optional<OilSpring> FitOilSpring(const model::Parameters& model, const runs::MeasuredRun& run);

// The values, a missing one as the last before it; and the root of their mean square.
Eigen::VectorXd Held(const std::vector<double>& values);
double Rms(const Eigen::VectorXd& values);

}  // namespace hydro::diagnose
