// Pressures that nobody measured in a clamped run, marched from the flow balances: each flow column then acts in the torque balance,
// through the pressure that it makes. With a free arm a few per cent in D/c integrate to many times the pressure: not there.
#pragma once

#include "diagnose/balances/balance_series.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Whether a pressure of the run is missing that may be marched: the shaft is clamped, the bypass closed, the speed known.
bool MayMarch(const RunMotion& run);

// Fills in each missing pressure p by V/beta p' = what flows in, which stays at p_3 where the one-way valve holds it, with the
// values and effects of `model`. It starts from what the torque balance says of the first 20 ms. Sets pressures, and slopes.
void MarchPressures(const model::ModelDescription& model, RunMotion* run);

// What a change of the balances at given pressures is once the marched pressures have followed it: V/beta delta' = (slopes of the
// flow) delta + change of the flow, delta = 0 while a valve holds the side. `start`: of delta at the beginning, psi.
BalanceSeries AfterPressures(const RunMotion& run, BalanceSeries change, double start = 0);

}  // namespace hydro::diagnose
