#include "sim/simulation.h"

#include "base/input_error.h"
#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"

namespace hydro {

SimulationResult Simulate(const StackConfig& config, const std::function<void(const RawMessage&)>& tap) {
  if (config.last_tick < 0) {
    throw InputError(
        config.file +
        ": time.duration_s: found 0, a simulation needs an end: allowed is > 0 (or --duration S)");
  }
  StackConfig lockstep = config;
  lockstep.time.mode = TimeMode::kLockstep;
  SimulatedClock clock;
  InProcessBus bus(&clock);
  if (tap) bus.SubscribeAll(tap);
  SimulatedRig rig(lockstep);
  PlantApp plant(bus, clock, lockstep, rig, {}, "hydro-sim");
  PressureApp pressure(bus, clock, lockstep);
  PositionApp position(bus, clock, lockstep);

  SimulationResult result;
  result.exit_code = plant.Run();
  const auto dispatch_all = [&] {
    while (bus.HandleUntil(clock.Now()) > 0) {
    }
  };
  dispatch_all();
  position.Finish();
  pressure.Finish();
  dispatch_all();
  result.ticks = plant.tick();
  result.duration = static_cast<double>(plant.tick()) / config.plant.rate_hz;
  result.failure = plant.failure();
  return result;
}

}  // namespace hydro
