// The terms of the model's balances as a recording has them, integrated over short segments.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// By window, a row of terms for each segment.
using BalanceRows = std::vector<std::vector<Eigen::VectorXd>>;

// What an angle moves, and the integral of its speed.
BalanceRows RatesOfAngles(const std::vector<runs::MeasuredRun>& windows,
                          const runs::MeasuredSignal runs::MeasuredRun::*angle,
                          const runs::MeasuredSignal runs::MeasuredRun::*speed);

// Eq. (4): inertia, oil of both columns, viscous and dry friction, and the torque of the command times each of
// `commands`. Below `slowest` the direction of dry friction is not known.
BalanceRows TorqueRows(const model::Parameters& model, const std::vector<runs::MeasuredRun>& windows,
                       bool bypass, double slowest, const std::vector<double>& commands);

// Eqs. (13), (14), of the column `own` of `run`: compression, that of the displaced volume, the pump's flow, the arm's,
// leakage out, p_3's part of it, and leakage across by both pressures.
BalanceRows FlowRows(const model::Parameters& model, const runs::MeasuredRun& run,
                     const std::vector<runs::MeasuredRun>& windows,
                     runs::MeasuredSignal runs::MeasuredRun::*own,
                     runs::MeasuredSignal runs::MeasuredRun::*other);

}  // namespace hydro::diagnose
