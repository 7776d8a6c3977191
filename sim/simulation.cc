#include "sim/simulation.h"

#include <algorithm>
#include <memory>

#include "base/host_name.h"
#include "base/input_error.h"
#include "base/random.h"
#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "sim/limb/limb.h"

namespace hydro::sim {
namespace {

void CheckEnds(const settings::StackConfig& config) {
  if (config.last_tick >= 0) return;
  throw InputError(config.file +
                   ": time.duration_s: found 0, allowed is > 0, because a simulation needs an end (or give "
                   "--duration S)");
}

// Sends the limb's own description; each joint speaks on its own channels.
void DescribeLimb(const settings::LimbConfig& config,
                  const std::function<void(const bus::RawMessage&)>& tap) {
  bus::SimulatedClock clock;
  bus::InProcessBus bus(&clock);
  bus.SubscribeAll(tap);
  run_description_t description = limb::DescriptionOf(config, "hydro-sim");
  description.session = SessionOf(config.common);
  description.utime = clock.Utime();
  description.host = HostName();
  bus.Publish(bus::Channels(config.common.bus.channel_suffix).Of<run_description_t>(), description);
  bus.HandleUntil(clock.Now());
}

}  // namespace

int64_t SessionOf(const settings::StackConfig& config) {
  const uint64_t key = Scatter(NameKey(config.text) ^ Scatter(NameKey(config.model.text)));
  return std::max<int64_t>(1, static_cast<int64_t>(key >> 1));
}

SimulationResult Simulate(const settings::StackConfig& config,
                          const std::function<void(const bus::RawMessage&)>& tap,
                          const std::vector<tuned_settings_t>& tunings,
                          const model::ModelDescription* machine) {
  CheckEnds(config);
  settings::StackConfig lockstep = config;
  lockstep.time.mode = settings::TimeMode::kLockstep;
  bus::SimulatedClock clock(SessionOf(config));
  bus::InProcessBus bus(&clock);
  if (tap) bus.SubscribeAll(tap);
  settings::StackConfig simulated = lockstep;
  if (machine != nullptr) simulated.model.description = *machine;
  plant::SimulatedRig rig(simulated);
  // A process whose stack cannot grow ends without a message, whereas a failed allocation is reported.
  const auto plant =
      std::make_unique<plant::PlantApp>(bus, clock, lockstep, rig, std::vector<std::string>{}, "hydro-sim");
  const auto pressure = std::make_unique<pressure_ctrl::PressureApp>(bus, clock, lockstep);
  const auto position = std::make_unique<position_ctrl::PositionApp>(bus, clock, lockstep);

  plant->FollowTuning(tunings);
  SimulationResult result;
  result.exit_code = plant->Run();
  const auto dispatch_all = [&] {
    while (bus.HandleUntil(clock.Now()) > 0) {
    }
  };
  dispatch_all();
  position->Finish();
  pressure->Finish();
  dispatch_all();
  result.ticks = plant->tick();
  result.duration = static_cast<double>(plant->tick()) / config.plant.rate_hz;
  result.failure = plant->failure();
  return result;
}

SimulationResult SimulateLimb(const settings::LimbConfig& config,
                              const std::function<void(const bus::RawMessage&)>& tap) {
  CheckEnds(config.common);
  limb::Limb limb(config, {.joints = {}, .program = "hydro-sim", .session = SessionOf(config.common)});
  if (tap) {
    DescribeLimb(config, tap);
    for (auto& joint : limb.joints()) joint->bus().SubscribeAll(tap);
  }
  if (limb.Begin()) {
    while (limb.StepLockstep()) {
    }
  }
  SimulationResult result;
  result.exit_code = limb.End({});
  result.ticks = limb.tick();
  result.duration = static_cast<double>(limb.tick()) / config.common.plant.rate_hz;
  result.failure = limb.failure();
  return result;
}

}  // namespace hydro::sim
