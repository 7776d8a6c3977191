// Curves as the balances of the runs show them, without any simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// The curves that a person knows a machine by: the pump's friction over the motor's speed, the leakage across its ports over
// p2 - p1, the arm's load over its angle. What eq. (4) leaves without its friction, eqs. (13) and (14) without the leakage across,
// and eq. (15) without the load: all other terms are those of `found`, and so are its readings. Friction and load count against
// the motion forward, leakage from side 2 to side 1. Only curves whose balance can be formed, from runs that move along them;
// a run whose arm is held has no load. Throws ModelError as Equations does.
std::vector<MeasuredCurve> MeasuredCurves(const model::ModelDescription& given,
                                          const model::ModelDescription& found,
                                          const std::vector<const RunData*>& runs, int jobs = 1);

// What `effect`, one of the model's, adds to the balance where it shows most, over the variable that it depends on there: what the
// runs lack without it, and its own (`found`). Empty for an effect that is no curve over a variable, as lags and late sensors are
// not, and for one that adds nothing in these runs.
std::optional<MeasuredCurve> TermOf(const model::ModelDescription& model, const std::string& effect,
                                    const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
