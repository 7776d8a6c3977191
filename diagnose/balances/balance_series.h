// The balances of a measured run over time: what the model's equations leave along the measured motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "diagnose/balances/rows.h"
#include "diagnose/balances/run_motion.h"
#include "model/response.h"

namespace hydro::diagnose {

inline constexpr size_t kBalanceKinds = 6;
inline constexpr std::array<BalanceKind, kBalanceKinds> kAllBalances = {
    BalanceKind::kTorque, BalanceKind::kFlow1,  BalanceKind::kFlow2,
    BalanceKind::kArm,    BalanceKind::kLevel1, BalanceKind::kLevel2};

// A number for every stride-th instant of the run, for each balance; empty: it cannot be formed from what was measured.
using BalanceSeries = std::array<Eigen::VectorXd, kBalanceKinds>;

// Whether the run's signals suffice for the balance. One that cannot be formed is left out: what is missing never counts as 0.
bool CanForm(const RunMotion& run, BalanceKind balance);
// Whether its series are computed: those of a side with a marched pressure act in the torque balance (latent_pressures.h).
bool IsComputed(const RunMotion& run, BalanceKind balance);

// What the motor's torque is over time, smoothed as the signals are.
struct Drive {
  std::vector<double> raw;     // at every instant, from then on
  std::vector<double> middle;  // the mean of just before and from then on
  std::vector<double> smooth;  // `middle`, smoothed
};

struct BaseSeries {
  BalanceSeries left;
  Drive drive;
};

// What the model leaves. Throws ModelError as Equations does.
BaseSeries SeriesOf(const model::ModelDescription& model, const RunMotion& run);
// What another model, or another motion of the same run, leaves beyond `base`. Effects' states are integrated along the
// motion.
BalanceSeries Beyond(const model::ModelDescription& model, const RunMotion& run, const BaseSeries& base);
// Whether the model differs by what it remembers of the command alone: noise of the sensors then makes no difference. Judged by the run's
// first samples.
bool DependsOnCommandAlone(const model::ModelDescription& model, const RunMotion& run,
                           const BaseSeries& base);
// The balances' derivatives by each of the unknowns. Empty where one of them changes the motor's torque, which depends
// on the held command: Beyond is for these.
std::vector<BalanceSeries> DerivativesOf(const model::ModelDescription& model, const RunMotion& run,
                                         const std::vector<model::Unknown>& unknowns);
// What sensors would read beyond the motion because of the model's effects; smoothed, at every instant. Empty series: nothing.
SignalErrors ErrorsOf(const model::ModelDescription& model, const RunMotion& run);

}  // namespace hydro::diagnose
