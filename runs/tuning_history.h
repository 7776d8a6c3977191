// The changes of values while a run went on, as its log has them.
#pragma once

#include <hydro/tuned_settings_t.hpp>
#include <string>
#include <vector>

#include "runs/run_messages.h"

namespace hydro::runs {

// What was decided or in force, each version once, in the order of ticks; acts_at is not -1. The values as configured are none.
std::vector<tuned_settings_t> TuningHistory(const RunMessages& messages);

// The tick from which the process of that role acted by `settings`: as it says itself, else as was decided.
int64_t EffectTick(const RunMessages& messages, const tuned_settings_t& settings, const std::string& role);

// "version 1 from tick 5000 on: position.c2 = 900 (hydro-set)"; by what it differs from the configuration.
std::string DescribeTuning(const tuned_settings_t& settings);

}  // namespace hydro::runs
