// The whole stack in one process on a simulated clock: the same plant, pressure loop and position loop
// classes as in the separate processes, in lockstep, over an in-process bus.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/tuned_settings_t.hpp>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "settings/limb_config.h"
#include "settings/stack_config.h"

namespace hydro::sim {

struct SimulationResult {
  int64_t ticks = 0;    // the last tick
  double duration = 0;  // s, plant time of that tick
  int exit_code = 0;    // 0 complete, 1 failed
  std::string failure;  // why, empty when complete
};

// The session of a simulation of `config`, never 0: by it the states of a run are told from those of any other. It comes from
// what is simulated, so that the same simulation has the same one.
int64_t SessionOf(const settings::StackConfig& config);

// Runs `config` to its end, in lockstep whatever time.mode says, and passes every message to `tap` (null:
// nothing is even encoded). Throws InputError when the configuration has no duration or contradicts the
// model. `tunings`: changes that were decided in another run, made again at the same ticks. `machine`: what
// is simulated, where it is another machine than the model of `config`, which the controllers know. In that
// model's units; null: the model itself.
SimulationResult Simulate(const settings::StackConfig& config,
                          const std::function<void(const bus::RawMessage&)>& tap,
                          const std::vector<tuned_settings_t>& tunings = {},
                          const model::ModelDescription* machine = nullptr);

// Throws what Simulate() would throw before its first tick.
void CheckSimulates(const settings::StackConfig& config, const model::ModelDescription* machine = nullptr);

// As Simulate(), for all joints of a limb, each on channels of its own suffix.
SimulationResult SimulateLimb(const settings::LimbConfig& config,
                              const std::function<void(const bus::RawMessage&)>& tap);

}  // namespace hydro::sim
