// How well three models predict: the model as given, the same model refitted, and the model with what was
// found. Whole runs add up every small error of a model; windows of several lengths show how well it knows
// the next moments.
#pragma once

#include <array>
#include <vector>

#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The models that are compared, in the order of BeforeAfter.
enum ComparedModel : size_t { kAsItWas, kRefitted, kWithWhatWasFound, kComparedModels };

using GapsByModel = std::array<std::vector<WindowGap>, kComparedModels>;

// Keeps only windows on which the models can be compared: those that all of them follow. A model that follows
// fewer than half of the windows counts as one that follows none. Otherwise only windows at rest might be
// left, which say nothing about windows in motion.
void KeepCommon(GapsByModel* gaps);

// The runs as each model leaves them: those that are fitted, and those that are predicted
// (ProofContext::predicted()) by models that did not see them.
struct WholeRuns {
  GapsByModel fitted, held_out;
};
WholeRuns OverWholeRuns(const ProofContext& context, const Proof& proof);

// Sets `fit`, `held_out` and `signals`: root-mean-square residuals. They are infinite where a run cannot be
// simulated; for a single signal, they come from the other runs.
void DescribeGaps(const ProofContext& context, const WholeRuns& whole, Diagnosis* d);

// Gaps over 0.1, 0.4 and 1.6 s, as far as the runs are long enough. Windows are spread evenly over the runs.
// Models are compared on windows that all of them follow (KeepCommon()); NaN where no window is left.
std::vector<HorizonGap> HorizonGaps(const ProofContext& context, const Proof& proof);

}  // namespace hydro::diagnose
