// How well the model as given, the same refitted, and that with what was found predict: whole runs, which add up every small error of
// a model, and windows of several lengths, which show what it knows of the next moments.
#pragma once

#include <array>
#include <vector>

#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The models that are compared, in the order of BeforeAfter.
enum ComparedModel : size_t { kAsItWas, kRefitted, kWithWhatWasFound, kComparedModels };

using GapsByModel = std::array<std::vector<WindowGap>, kComparedModels>;

// Leaves only what compares the models of the same windows: those that all of them follow, where a model that follows fewer than half of
// the windows counts as one that follows none. What is left of windows at rest says nothing of those that move.
void KeepCommon(GapsByModel* gaps);

// The runs as each model leaves them: those that are fitted, and those that are predicted (ProofContext::predicted()), by models that
// did not see them.
struct WholeRuns {
  GapsByModel fitted, held_out;
};
WholeRuns OverWholeRuns(const ProofContext& context, const Proof& proof);

// Sets `fit`, `held_out` and `signals`, root-mean-square residuals. Infinite where a run cannot be simulated; of a signal, those of
// the other runs.
void DescribeGaps(const ProofContext& context, const WholeRuns& whole, Diagnosis* d);

// Over 0.1, 0.4 and 1.6 s, as far as the runs are that long. Windows are spread evenly over the runs. Models are compared on
// windows that all of them follow (KeepCommon()); NaN where none is left.
std::vector<HorizonGap> HorizonGaps(const ProofContext& context, const Proof& proof);

}  // namespace hydro::diagnose
