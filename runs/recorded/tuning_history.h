// The changes of values during a run, as its log has them.
#pragma once

#include <cstdint>
#include <hydro/tuned_settings_t.hpp>
#include <string>
#include <vector>

#include "runs/recorded/run_log.h"

namespace hydro::runs {

// The values that were decided or in force, each version once, in the order of ticks. acts_at is not -1. The
// configured values do not count as a change.
std::vector<tuned_settings_t> TuningHistory(const RunMessages& messages);

// The tick from which the process of that role applied `settings`: as it reports itself, or else as decided.
int64_t EffectTick(const RunMessages& messages, const tuned_settings_t& settings, const std::string& role);

// One version of the values, as the changes from the version before it.
struct TuningStep {
  int64_t version = 0;
  int64_t tick = 0;     // tick from which it acts
  std::string source;   // the requester
  std::string changes;  // lines "key = value", or "key as configured" where a value was restored
  bool before_unknown =
      false;  // the version before it is unknown, so `changes` compares it with the configuration
};

// `before` holds the values in force until then; null: unknown. The configuration itself is version 0.
TuningStep StepTo(const tuned_settings_t& settings, const tuned_settings_t* before);

// The steps of all versions in the history, in the order of ticks.
std::vector<TuningStep> TuningSteps(const RunMessages& messages);

// "version 2 from tick 5000 on: position.c2 = 900 (hydro-set)"
std::string DescribeTuning(const TuningStep& step);

// "version 2 since tick 5000 (hydro-set); differs from the configuration: position.c2 = 900", or "version 0:
// as configured".
std::string DescribeInForce(const tuned_settings_t& settings);

}  // namespace hydro::runs
