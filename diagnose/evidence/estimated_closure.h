// Converts a closure of the scan into effects of a model: a curve at knots.
#pragma once

#include <string>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

// The curve that `fit` has for the closure `set`, as effects of the catalogue, one for each balance in which
// it acts. The result is empty where no effect of the catalogue can state the curve.
std::vector<model::EffectDescription> ClosuresOf(const ScanRuns& runs, const Rows& rows,
                                                 const std::string& set, const SetFit& fit);

}  // namespace hydro::diagnose
