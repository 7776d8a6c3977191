// The closed oil between motor and arm acts as a spring against the motor's torque. This shows in a recording
// with or without pressures.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "model/terms/terms.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

struct OilSpring {
  double stiffness = 0, error = 0;    // of the closed oil's spring
  double left = 1, left_without = 1;  // part of the squared torque: with the spring, and without
  double inertia = 1;                 // of the model's inertia
  double would_take = 0,
         at_most = 0;              // part of the torque, by closed oil: where it is fast, and at any speed
  double follows = 0, volume = 0;  // the arm's correlation with the motor, and the ratio of their volumes
  double moved = 0;                // total volume that the arm displaced, divided by the motor's
};

// Fits the spring from the command, the motor's motion and, unless the shaft is clamped, the arm's motion.
// The run must have the motor's speed or angle and, unless it is clamped, the arm's. The result is empty
// where the run is too short or too slow.
std::optional<OilSpring> FitOilSpring(const model::Parameters& model, const runs::MeasuredRun& run);

// The values, each missing one replaced by the last before it; and their root mean square.
Eigen::VectorXd Held(const std::vector<double>& values);
double Rms(const Eigen::VectorXd& values);

}  // namespace hydro::diagnose
