#include "sim/simulation.h"

#include <algorithm>
#include <hydro/fault_t.hpp>
#include <memory>

#include "base/host_name.h"
#include "base/input_error.h"
#include "base/random.h"
#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "launch/logic/run_summary.h"
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

// Adds the faults that are heard on `bus` to `summary`. `joint` is empty outside a limb. All participants of
// a simulation have one session, so that only their names tell the senders apart.
void HearFaults(bus::Bus& bus, const std::string& suffix, const std::string& joint,
                launch::RunSummary* summary) {
  bus.Subscribe<fault_t>(bus::Channels(suffix).Of<fault_t>(), [joint, summary](const fault_t& heard) {
    fault_t fault = heard;
    fault.session = 0;
    if (!joint.empty()) fault.source = joint + " " + heard.source;
    summary->Add(fault);
  });
}

void TellFaults(const launch::RunSummary& summary, SimulationResult* result) {
  result->fault_lines = summary.Lines();
  result->faults_left = launch::FaultsLeftText(summary.FaultsLeft());
}

// Sends the limb's own description; each joint speaks on its own channels.
void DescribeLimb(const settings::LimbConfig& config,
                  const std::function<void(const bus::RawMessage&)>& tap) {
  bus::SimulatedClock clock;
  bus::InProcessBus bus(&clock);
  bus.SubscribeAll(tap);
  run_description_t description = plant::DescriptionOf(config.common, "hydro-sim");
  description.session = SessionOf(config.common);
  description.utime = clock.Utime();
  description.host = HostName();
  bus.Publish(bus::Channels(config.common.bus.channel_suffix).Of<run_description_t>(), description);
  bus.HandleUntil(clock.Now());
}

// Everything that takes part in a simulation.
struct Stack {
  Stack(const settings::StackConfig& config, const std::function<void(const bus::RawMessage&)>& tap,
        const model::ModelDescription* machine)
      : lockstep(InLockstep(config)),
        clock(SessionOf(config)),
        bus(&clock),
        rig(WithMachine(lockstep, machine)) {
    if (tap) bus.SubscribeAll(tap);
    HearFaults(bus, lockstep.bus.channel_suffix, "", &faults);
    plant =
        std::make_unique<plant::PlantApp>(bus, clock, lockstep, rig, std::vector<std::string>{}, "hydro-sim");
    pressure = std::make_unique<pressure_ctrl::PressureApp>(bus, clock, lockstep);
    position = std::make_unique<position_ctrl::PositionApp>(bus, clock, lockstep);
  }

  static settings::StackConfig InLockstep(settings::StackConfig config) {
    CheckEnds(config);
    config.time.mode = settings::TimeMode::kLockstep;
    return config;
  }
  static settings::StackConfig WithMachine(settings::StackConfig config,
                                           const model::ModelDescription* machine) {
    if (machine != nullptr) config.model.description = *machine;
    return config;
  }

  const settings::StackConfig lockstep;
  bus::SimulatedClock clock;
  bus::InProcessBus bus;
  launch::RunSummary faults;
  plant::SimulatedRig rig;
  // A process whose stack cannot grow ends without a message, whereas a failed allocation is reported.
  std::unique_ptr<plant::PlantApp> plant;
  std::unique_ptr<pressure_ctrl::PressureApp> pressure;
  std::unique_ptr<position_ctrl::PositionApp> position;
};

}  // namespace

int64_t SessionOf(const settings::StackConfig& config) {
  const uint64_t key = Scatter(NameKey(config.text) ^ Scatter(NameKey(config.model.text)));
  return std::max<int64_t>(1, static_cast<int64_t>(key >> 1));
}

void CheckSimulates(const settings::StackConfig& config, const model::ModelDescription* machine) {
  const Stack stack(config, {}, machine);
}

SimulationResult Simulate(const settings::StackConfig& config,
                          const std::function<void(const bus::RawMessage&)>& tap,
                          const std::vector<tuned_settings_t>& tunings,
                          const model::ModelDescription* machine) {
  Stack stack(config, tap, machine);
  stack.plant->FollowTuning(tunings);
  SimulationResult result;
  result.exit_code = stack.plant->Run();
  const auto dispatch_all = [&] {
    while (stack.bus.HandleUntil(stack.clock.Now()) > 0) {
    }
  };
  dispatch_all();
  stack.position->Finish();
  stack.pressure->Finish();
  dispatch_all();
  result.ticks = stack.plant->tick();
  result.duration = static_cast<double>(stack.plant->tick()) / config.plant.rate_hz;
  result.failure = stack.plant->failure();
  TellFaults(stack.faults, &result);
  return result;
}

SimulationResult SimulateLimb(const settings::LimbConfig& config,
                              const std::function<void(const bus::RawMessage&)>& tap) {
  CheckEnds(config.common);
  launch::RunSummary faults;
  limb::Limb limb(config, {.joints = {}, .program = "hydro-sim", .session = SessionOf(config.common)});
  if (tap) {
    DescribeLimb(config, tap);
    for (auto& joint : limb.joints()) joint->bus().SubscribeAll(tap);
  }
  for (auto& joint : limb.joints())
    HearFaults(joint->bus(), joint->config().bus.channel_suffix, joint->name(), &faults);
  if (limb.Begin()) {
    while (limb.StepLockstep()) {
    }
  }
  SimulationResult result;
  result.exit_code = limb.End({});
  result.ticks = limb.tick();
  result.duration = static_cast<double>(limb.tick()) / config.common.plant.rate_hz;
  result.failure = limb.failure();
  TellFaults(faults, &result);
  return result;
}

}  // namespace hydro::sim
