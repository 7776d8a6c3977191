// What balances and simulation say together.
#pragma once

#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Gives each explanation the mean of two weights: what the balances of the fitted runs say, and what the proof makes of it, which has
// predicted held-out windows. Each of them is wrong on other machines: where they disagree, either was right as often, so that none is
// surer than even. Where nothing could be simulated, the balances' weights stay. Sorts the explanations, counts
// set_90 anew, and weighs the effects that were found.
void HearBothWitnesses(const Proof& proof, Diagnosis* d);

}  // namespace hydro::diagnose
