// What was proved, as a diagnosis states it: effects, closures and values with intervals, shares, weights and ties.
#pragma once

#include <vector>

#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Adds the effects, the closures and the parameters of the best set to `d`, which has the explanations and `set_90`.
// - An effect's weight is that of all explanations that have it; NaN where the balances cannot speak for it and none does.
// - Its share is the part of the typical held-out squared gap above the noise that comes back without it, of that which the model's
//   own values leave: how far they were off is nothing that an effect takes. NaN where that was not proved.
// - It is tied with what stands in its place in another set that was proved, is among the likeliest that hold the truth nine times in
//   ten (or has an effect that balances cannot see), and predicts the windows that judge as well within the error of the comparison.
// Returns the model that was found and those of the ties.
std::vector<model::ModelDescription> DescribeFound(const ProofContext& context, const Proof& proof,
                                                   Diagnosis* d);

}  // namespace hydro::diagnose
