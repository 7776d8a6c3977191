// Where a closure begins: its knots, from the smoother's tables, and values of 0. A closure is linear in its values, so
// that the first step of a fit from 0 goes the right way; the tables' means may lie far off, as pressures in stiff oil
// answer to both flows together.
#pragma once

#include "diagnose/locate/locate.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// A curve with at most `knots` knots, the first and the last at the ends of what the runs reach.
model::EffectDescription CurveOf(const PossibleTerm& term, size_t knots);

// A surface over the variables of both, in the balance of `first`.
model::EffectDescription SurfaceOf(const PossibleTerm& first, const PossibleTerm& second);

// The values of a closure.
const std::vector<double>& ValuesOf(const model::EffectDescription& closure);

}  // namespace hydro::diagnose
