// The windows on which proposals are proved. Some are fitted, others judge.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "diagnose/fit/turn.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Judging windows of one length.
struct JudgingWindows {
  double seconds = 0;
  std::vector<const RunData*> windows;
  std::vector<size_t> runs;  // the run of each window: its place in ProofContext::predicted()
  std::shared_ptr<KnownTurns> turns = nullptr;  // null: searched for each model
};

struct ProofWindows {
  // Owns all windows below.
  std::shared_ptr<const std::vector<RunData>> all;
  std::vector<const RunData*> told;    // of the fitted runs, for intervals: more than a fit can afford
  std::vector<const RunData*> fitted;  // of the fitted runs, as long as the windows of `near`
  // 0.4 s: over 0.1 s the window's unknown start hides a lag, and over 1.6 s errors of the base values
  // outweigh what is missing (both measured).
  JudgingWindows near;
  JudgingWindows far;  // four times as long; shorter runs have none
};

// s, the length of near windows of these runs; shorter runs judge nothing, unless most runs are shorter. Far
// windows are kFarTimes as long.
double NearHorizon(const std::vector<const RunData*>& runs);
inline constexpr double kFarTimes = 4;

// Judging windows come from the held-out runs. Without held-out runs they come from the fitted runs and
// alternate with the windows that are fitted. They are spread over the runs and include those where a
// pressure or the speed is largest, because anything that opens or saturates acts only there.
ProofWindows ProofWindowsOf(const ProofContext& context);

}  // namespace hydro::diagnose
