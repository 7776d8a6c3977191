// The changes of values while a run went on, as its log has them.
#pragma once

#include <cstdint>
#include <hydro/tuned_settings_t.hpp>
#include <string>
#include <vector>

#include "runs/run_messages.h"

namespace hydro::runs {

// What was decided or in force, each version once, in the order of ticks; acts_at is not -1. The values as configured are none.
std::vector<tuned_settings_t> TuningHistory(const RunMessages& messages);

// The tick from which the process of that role acted by `settings`: as it says itself, else as was decided.
int64_t EffectTick(const RunMessages& messages, const tuned_settings_t& settings, const std::string& role);

// One version of the values: what it changes of the version before it.
struct TuningStep {
  int64_t version = 0;
  int64_t tick = 0;     // from which it acts
  std::string source;   // who asked for it
  std::string changes;  // lines "key = value", or "key as configured" where a value came back
  bool before_unknown =
      false;  // the version before it is not known: `changes` is how it differs from the configuration
};

// `before`: what was in force until then; null: not known. The configuration itself is version 0.
TuningStep StepTo(const tuned_settings_t& settings, const tuned_settings_t* before);

// Of each version of the history, in the order of ticks.
std::vector<TuningStep> TuningSteps(const RunMessages& messages);

// "version 2 from tick 5000 on: position.c2 = 900 (hydro-set)"
std::string DescribeTuning(const TuningStep& step);

// "version 2 since tick 5000 (hydro-set); differs from the configuration: position.c2 = 900", or "version 0: as configured".
std::string DescribeInForce(const tuned_settings_t& settings);

}  // namespace hydro::runs
