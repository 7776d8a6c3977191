// States what was proved in a diagnosis: effects, closures and values with intervals, shares, weights and
// ties.
#pragma once

#include <vector>

#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Adds the effects, the closures and the parameters of the best set to `d`, which already has the
// explanations and `set_90`.
// - An effect's weight is that of all explanations that have it. It is NaN where the balances cannot speak
//   for the effect and no explanation has it.
// - Its share is the part of the typical held-out squared gap above the noise that returns without the
//   effect, relative to what the model's own values leave: the error of these values is no merit of an
//   effect. It is NaN where this was not proved.
// - It is tied with what replaces it in another set if that set was proved, is among the likeliest that hold
//   the truth nine times in ten (or has an effect that balances cannot see), and predicts the judging windows
//   as well within the error of the comparison.
// Returns the model that was found and the models of the ties.
std::vector<model::ModelDescription> DescribeFound(const ProofContext& context, const Proof& proof,
                                                   Diagnosis* d);

}  // namespace hydro::diagnose
