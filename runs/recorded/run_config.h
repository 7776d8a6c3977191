// Facts about a run from its log's description, even if this version does not accept that description as a
// configuration, and whether its log has every state.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/unit_system.h"
#include "hydro/run_description_t.hpp"
#include "runs/recorded/run_log.h"

namespace hydro::runs {

// The keys of the configuration as "section.key" with their values as TOML, sorted by key; empty when there
// is no configuration. `file` names the log in messages. Throws InputError when the text is not TOML.
std::vector<std::pair<std::string, std::string>> ConfigEntries(const run_description_t& description,
                                                               const std::string& file);

// plant.command_delay_ticks, 0 or 1 (default 1): a command computed from tick k acts from tick k + this.
// Throws InputError for any other value.
int CommandDelayTicks(const run_description_t& description, const std::string& file);

// The model's name; empty when its text has none.
std::string ModelName(const run_description_t& description, const std::string& file);

// Throws InputError unless the texts of configuration and model are TOML, which damaged ones are not.
void RequireReadable(const run_description_t& description, const std::string& file);

// The units of the run's model; the paper's where there is no model.
UnitSystem ModelUnits(const run_description_t& description, const std::string& file);

// Ticks from one state to the next where a limb sent its joints' states at a chosen rate (limb.telemetry_hz);
// 1: every state was sent.
int64_t SampleTicks(const RunMessages& messages);

// "a state every 20 ticks (limb.telemetry_hz)"; empty where every state was sent.
std::string DescribeSampling(int64_t sample_ticks);

// Throws InputError where states are missing on purpose, because the work named by `needs_it` ("a replay")
// would take them for lost.
void RequireEveryState(const RunLog& log, const std::string& needs_it);

}  // namespace hydro::runs
