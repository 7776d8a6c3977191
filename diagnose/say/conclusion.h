// Draws conclusions from what was proposed and proved: the verdict, ties, intervals and reasons.
#pragma once

#include "diagnose/prove/proof.h"
#include "diagnose/prove/propose.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Takes weights from what the balances propose, and names effects from what was proved.
Diagnosis Conclude(const ProofContext& context, const Proof& proof, const Proposed& proposed = {});

}  // namespace hydro::diagnose
