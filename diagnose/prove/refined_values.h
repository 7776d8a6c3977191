// Values refined by simulation: a few steps of a fit to windows of the fitted runs.
#pragma once

#include <memory>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proved_set.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Copies of the windows, with the noise of each signal raised to what the model leaves of it in the median window, and in windows
// that it leaves much more of, to a third of that. What a model lacks grows with the time from the window's start and is no white noise:
// weighted by the sensors alone, a fit would move all values to mend the signal with the finest sensor. Without windows that the
// model cannot be simulated over.
std::vector<RunData> WithDiscrepancy(const std::vector<const RunData*>& windows,
                                     const model::ModelDescription& model, int jobs);

// How far values are refined: what is known of the base values weighs by the gap, which falls on the way, so that it is weighed
// anew in each round.
struct Refinement {
  int rounds = 0;
  int steps = 0;  // of a round
};
// To compare a set with that without an effect: estimates are near where a fit ends, and one that needs more steps is wandering off.
inline constexpr Refinement kComparedValues = {2, 3};
// Of what is reported.
inline constexpr Refinement kReportedValues = {3, 8};

// The set with its values fitted, a few steps from where they are; the fit is taken where it predicts the judging windows better.
// `fitted`: as WithDiscrepancy() makes them. A fit that fails, or ends no lower than it began, changes nothing.
void RefineValues(const ProofContext& context, const std::vector<const RunData*>& fitted,
                  const ProofWindows& windows, const Refinement& limits, ProvedSet* set);

// What is known of the hypothesis' base values where a fit to these windows leaves `sum`; null where only those are free that the set
// itself names.
std::shared_ptr<const Knowledge> KnownOfValues(const ProofContext& context,
                                               const std::vector<const RunData*>& windows,
                                               const Hypothesis& hypothesis, double sum);

// The starts that the model's windows have: measured, corrected by a step.
std::vector<model::StartState> CorrectedStarts(const model::ModelDescription& model,
                                               const std::vector<const RunData*>& windows, int jobs);

}  // namespace hydro::diagnose
