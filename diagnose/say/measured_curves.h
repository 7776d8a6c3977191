// The curves that a person knows a machine by, as its runs show them without any simulation: the pump's friction over the
// motor's speed, the leakage across the ports over p2 - p1, the arm's load over its angle.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// What eq. (4) leaves without its friction, eqs. (13) and (14) without the leakage across, and eq. (15) without the load:
// all other terms are those of `found`, and so are its readings. Friction and load count against the motion forward,
// leakage from side 2 to side 1. Only curves whose balance can be formed, from runs that move along them; a run whose
// arm is held has no load. Throws ModelError as Equations does.
std::vector<MeasuredCurve> MeasuredCurves(const model::ModelDescription& given,
                                          const model::ModelDescription& found,
                                          const std::vector<const RunData*>& runs, int jobs = 1);

}  // namespace hydro::diagnose
