// Combines what balances and simulation say.
#pragma once

#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Gives each explanation the mean of two weights: the weight from the balances of the fitted runs, and the
// weight from the proof, which has predicted held-out windows. Each of the two is wrong on different
// machines, and where they disagreed, each was right equally often, so that neither alone counts for more
// than even odds. Where nothing could be simulated, the balances' weights stay. Sorts the explanations,
// counts set_90 anew, and weighs the effects that were found.
void HearBothWitnesses(const Proof& proof, Diagnosis* d);

}  // namespace hydro::diagnose
