// The windows on which proposals are proved: some are fitted, others judge.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// Windows of one length that judge.
struct JudgingWindows {
  double seconds = 0;
  std::vector<const RunData*> windows;
  std::vector<size_t> runs;  // that each is from: its place in ProofContext::predicted()
};

struct ProofWindows {
  model::ModelDescription given;  // with how well its values are known
  // Owns all below.
  std::shared_ptr<const std::vector<RunData>> all;
  std::vector<const RunData*> told;  // of the fitted runs: what intervals rest on, more than a fit can afford
  std::vector<const RunData*> fitted;  // of the fitted runs, as long as those of `near`
  // 0.4 s: a lag shows less in 0.1 s than where the window begins, and over 1.6 s the base values' errors outweigh what is
  // missing (both measured).
  JudgingWindows near;
  JudgingWindows far;  // four times as long; none of runs that are shorter
};

// Judging windows are of the held-out runs; where there are none, of the fitted runs, in turn with those that are fitted. They are
// spread over the runs, and those where a pressure or the speed is largest are among them: what opens or saturates acts in no others.
ProofWindows ProofWindowsOf(const ProofContext& context);

}  // namespace hydro::diagnose
