// Pressures that were not measured in a clamped run are marched from the flow balances. Each flow column then
// acts in the torque balance through the pressure that it makes. This is not done with a free arm, where an
// error of a few per cent in D/c integrates to many times the pressure.
#pragma once

#include "diagnose/balances/balance_series.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Whether the run lacks a pressure that may be marched: the shaft is clamped, the bypass is closed, and the
// speed is known.
bool MayMarch(const RunMotion& run);

// Fills in each missing pressure p by V/beta p' = the flow into its side, with the values and effects of
// `model`. The pressure stays at p_3 while the one-way valve holds it. It starts from the value that the
// torque balance gives for the first 20 ms. Sets pressures and slopes.
void MarchPressures(const model::ModelDescription& model, RunMotion* run);

// Converts a change of the balances at given pressures into the change once the marched pressures have
// followed it: V/beta delta' = (slopes of the flow) delta + change of the flow, with delta = 0 while a valve
// holds the side. `start` is delta at the beginning, psi.
BalanceSeries AfterPressures(const RunMotion& run, BalanceSeries change, double start = 0);

}  // namespace hydro::diagnose
