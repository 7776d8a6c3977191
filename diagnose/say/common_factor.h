// Values that differ from the model's by one factor.
#pragma once

#include <string>

#include "diagnose/prove/proof.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// What to say where every torque that was refitted differs from the model's by the same factor, within its
// interval: the one value by which all of them are measured may be wrong instead (IsYardstick()). "" where
// this is not so, or where fewer than two torques were refitted. `d` already has its parameters.
std::string RemarkOnCommonFactor(const ProofContext& context, const Proof& proof, const Diagnosis& d);

}  // namespace hydro::diagnose
