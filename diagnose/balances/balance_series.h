// The balances of a measured run over time: what the model's equations leave along the measured motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "diagnose/balances/rows.h"
#include "diagnose/balances/run_motion.h"
#include "model/response.h"

namespace hydro::diagnose {

inline constexpr size_t kBalanceKinds = 6;
inline constexpr std::array<BalanceKind, kBalanceKinds> kAllBalances = {
    BalanceKind::kTorque, BalanceKind::kFlow1,  BalanceKind::kFlow2,
    BalanceKind::kArm,    BalanceKind::kLevel1, BalanceKind::kLevel2};

// The values of each balance at every stride-th instant of the run. A series is empty where the balance
// cannot be formed from what was measured.
using BalanceSeries = std::array<Eigen::VectorXd, kBalanceKinds>;

// Whether the run's signals suffice to form the balance. A balance that cannot be formed is left out: a
// missing signal never counts as 0.
bool CanForm(const RunMotion& run, BalanceKind balance);
// Whether the balance's series are computed. Those of a side whose pressure is marched act in the torque
// balance instead (latent_pressures.h).
bool IsComputed(const RunMotion& run, BalanceKind balance);

// The motor's torque over time, smoothed as the signals are.
struct Drive {
  std::vector<double> raw;     // at every instant, the value from that instant on
  std::vector<double> middle;  // the mean of the values just before the instant and from it on
  std::vector<double> smooth;  // `middle`, smoothed
};

struct BaseSeries {
  BalanceSeries left;
  Drive drive;
};

// The series that the model leaves. Throws ModelError as Equations does.
BaseSeries SeriesOf(const model::ModelDescription& model, const RunMotion& run);
// What another model, or another motion of the same run, leaves beyond `base`. The states of effects are
// integrated along the motion.
BalanceSeries Beyond(const model::ModelDescription& model, const RunMotion& run, const BaseSeries& base);
// Whether the model differs from the given one only by what it remembers of the command, so that sensor noise
// makes no difference to it. The run's first samples decide this.
bool DependsOnCommandAlone(const model::ModelDescription& model, const RunMotion& run,
                           const BaseSeries& base);
// The balances' derivatives by each of the unknowns. The result is empty where an unknown changes the motor's
// torque, which depends on the held command: use Beyond() for those.
std::vector<BalanceSeries> DerivativesOf(const model::ModelDescription& model, const RunMotion& run,
                                         const std::vector<model::Unknown>& unknowns);
// What the model's effects make the sensors read beyond the motion, smoothed, at every instant. An empty
// series means no error.
SignalErrors ErrorsOf(const model::ModelDescription& model, const RunMotion& run);

}  // namespace hydro::diagnose
