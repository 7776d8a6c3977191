// Curves as the balances of the runs show them, without any simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// The curves by which a person knows a machine: the pump's friction over the motor's speed, the leakage
// across its ports over p2 - p1, and the arm's load over its angle. They are what eq. (4) leaves without its
// friction, eqs. (13) and (14) without the leakage across, and eq. (15) without the load. All other terms,
// and the readings, are those of `found`. Friction and load are positive against forward motion, leakage from
// side 2 to side 1. A curve is included only if its balance can be formed from runs that move along it; a run
// whose arm is held has no load. Throws ModelError as Equations does.
std::vector<MeasuredCurve> MeasuredCurves(const model::ModelDescription& given,
                                          const model::ModelDescription& found,
                                          const std::vector<const RunData*>& runs, int jobs = 1);

// What `effect`, one of the model's, adds to the balance in which it shows most, over the variable on which
// it depends there: what the runs lack without it, and the effect's own term (`found`). Empty for an effect
// that is no curve over a variable, such as a lag or a late sensor, and for one that adds nothing in these
// runs.
std::optional<MeasuredCurve> TermOf(const model::ModelDescription& model, const std::string& effect,
                                    const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
