// The whole stack in one process on a simulated clock. The plant, pressure loop and position loop are the
// classes of the separate processes, in lockstep, over an in-process bus.
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
  int64_t ticks = 0;                     // the last tick
  double duration = 0;                   // s, plant time of that tick
  int exit_code = 0;                     // 0 complete, 1 failed
  std::string failure;                   // why, empty when complete
  std::vector<std::string> fault_lines;  // a line for each fault that came, as hydro-launch ends with
  // launch::FaultsLeftText() of those that held the voltage at zero at the end; empty: none did. Such a run
  // is complete for whoever only wants its messages; for hydro-sim it has failed, as for hydro-launch.
  std::string faults_left;
};

// The session of a simulation of `config`, never 0. It tells the states of a run from those of any other. It
// is computed from what is simulated, so that the same simulation always has the same session.
int64_t SessionOf(const settings::StackConfig& config);

// Runs `config` to its end, in lockstep whatever time.mode says, and passes every message to `tap` (null:
// messages are not even encoded). Throws InputError when the configuration has no duration or contradicts the
// model. `tunings` are changes that were decided in another run and are repeated at the same ticks. `machine`
// is the simulated machine, in the units of the model of `config`, where it differs from that model, which
// the controllers know. Null: the model itself.
SimulationResult Simulate(const settings::StackConfig& config,
                          const std::function<void(const bus::RawMessage&)>& tap,
                          const std::vector<tuned_settings_t>& tunings = {},
                          const model::ModelDescription* machine = nullptr);

// Throws what Simulate() would throw before its first tick.
void CheckSimulates(const settings::StackConfig& config, const model::ModelDescription* machine = nullptr);

// Does what Simulate() does for all joints of a limb, each on channels with its own suffix.
SimulationResult SimulateLimb(const settings::LimbConfig& config,
                              const std::function<void(const bus::RawMessage&)>& tap);

}  // namespace hydro::sim
