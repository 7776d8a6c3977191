// Refines values by simulation: a few steps of a fit to windows of the fitted runs.
#pragma once

#include <memory>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proved_set.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Copies the windows and raises each signal's noise to what the model leaves of it in the median window, and
// in windows where the model leaves much more, to a third of that. What a model lacks grows with the time
// from the window's start and is not white noise. With the sensors' weights alone, a fit would move all
// values to correct the signal with the finest sensor. Windows that the model cannot simulate are left out.
std::vector<RunData> WithDiscrepancy(const std::vector<const RunData*>& windows,
                                     const model::ModelDescription& model, int jobs);

// How far values are refined. Prior knowledge of the base values is weighed by the gap. The gap falls during
// the refinement, so each round weighs the knowledge anew.
struct Refinement {
  int rounds = 0;
  int steps = 0;            // in each round
  bool line_search = true;  // as FitOptions has it
};
// For comparing a set with the set without an effect. Estimates lie near the end of a fit; one that needs
// more steps is wandering off.
inline constexpr Refinement kComparedValues = {2, 3, false};
// For values that are reported.
inline constexpr Refinement kReportedValues = {3, 8, true};

// Fits the set's values by a few steps from where they are, and takes the fit if it predicts the judging
// windows better. `fitted` has windows made by WithDiscrepancy(). A fit that fails, or that ends no lower
// than it began, changes nothing.
void RefineValues(const ProofContext& context, const std::vector<const RunData*>& fitted,
                  const ProofWindows& windows, const Refinement& limits, ProvedSet* set);

// What is known of the hypothesis' base values where a fit to these windows leaves `sum`. Null where the only
// free values are those that the set itself names.
std::shared_ptr<const Knowledge> KnownOfValues(const ProofContext& context,
                                               const std::vector<const RunData*>& windows,
                                               const Hypothesis& hypothesis, double sum);

// The starts of the model's windows: measured, then corrected by one step.
std::vector<model::StartState> CorrectedStarts(const model::ModelDescription& model,
                                               const std::vector<const RunData*>& windows, int jobs);

}  // namespace hydro::diagnose
