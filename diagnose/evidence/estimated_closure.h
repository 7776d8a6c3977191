// A closure of the scan as effects of a model: a curve at knots.
#pragma once

#include <string>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

// The curve that `fit` has for the closure `set`, as effects of the catalogue: one for each balance that it acts in. Empty where no
// effect of the catalogue can state it.
std::vector<model::EffectDescription> ClosuresOf(const ScanRuns& runs, const Rows& rows,
                                                 const std::string& set, const SetFit& fit);

}  // namespace hydro::diagnose
