// The changes of values during a run, as its log has them.
#pragma once

#include <hydro/tuned_settings_t.hpp>
#include <string>
#include <vector>

#include "runs/run_messages.h"

namespace hydro::runs {

// The values that were decided or in force, each version once, in the order of ticks. acts_at is not -1. The
// configured values do not count as a change.
std::vector<tuned_settings_t> TuningHistory(const RunMessages& messages);

// The tick from which the process of that role applied `settings`: as it reports itself, or else as decided.
int64_t EffectTick(const RunMessages& messages, const tuned_settings_t& settings, const std::string& role);

// "version 1 from tick 5000 on: position.c2 = 900 (hydro-set)": the values that differ from the
// configuration.
std::string DescribeTuning(const tuned_settings_t& settings);

}  // namespace hydro::runs
