#include "sim/torture/programs.h"

#include <memory>

#include "base/integers.h"
#include "bus/channels.h"
#include "logger/logger_app.h"
#include "plant/plant_app.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/app.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/faulty_rig.h"
#include "sim/torture/world.h"

namespace hydro::torture {
namespace {

template <class Application>
SimulatedProcess::Body Running(const settings::StackConfig& config) {
  return [&config](bus::Bus& bus, bus::Clock& clock) {
    const auto app = std::make_unique<Application>(bus, clock, config);  // too large for a fiber's stack
    return process::RunApp(bus, clock, *app);
  };
}

// Whether a heartbeat has reached a plant. Without a launcher in the simulation, heartbeats come all the
// time, except when the launcher is said to hang.
bool Beats(World& world, int number) {
  SimulatedProcess& plant = world.process(number);
  const bool beats = world.has_launcher() ? plant.TakeBeat() : world.launcher_hangs() == 0;
  if (beats) world.observer().OnHeartbeat(plant);
  return beats;
}

}  // namespace

SimulatedProcess::Body ProgramOf(Role role, const settings::StackConfig& config, World& world, int number) {
  switch (role) {
    case Role::kKneePressure:
    case Role::kPressure:
      return Running<pressure_ctrl::PressureApp>(config);
    case Role::kKneePosition:
    case Role::kPosition:
      return Running<position_ctrl::PositionApp>(config);
    case Role::kLogger:
      return [&config, &world, number](bus::Bus& bus, bus::Clock& clock) {
        logger::LoggerOptions options;
        options.file = world.NewLog(number);
        options.disk_is_ready = [&world] { return world.disk().ready(); };
        const auto app = std::make_unique<logger::LoggerApp>(bus, clock, config, options);
        return process::RunApp(bus, clock, *app);
      };
    case Role::kLauncher:
      return LaunchProgram(config, world, number);
    case Role::kKneePlant:
      return [&config](bus::Bus& bus, bus::Clock& clock) {
        plant::SimulatedRig rig(config);
        return std::make_unique<plant::PlantApp>(bus, clock, config, rig)->Run();
      };
    default:
      return [&config, &world, number](bus::Bus& bus, bus::Clock& clock) {
        const std::vector<std::string> expected(world.has_logger() ? 1 : 0, "logger");
        BoardFaults* const board = world.has_driver() ? &world.board() : nullptr;
        FaultyRig rig(config, world.process(number), world.sensor_faults(), board, world.observer());
        const char* const program = board == nullptr ? "hydro-plant" : "hydro-driver";
        const auto app = std::make_unique<plant::PlantApp>(bus, clock, config, rig, expected, program,
                                                           [&world, number] { return Beats(world, number); });
        return app->Run();
      };
  }
}

SimulatedProcess::Body InsiderProgram(const settings::StackConfig& config, double voltage, double seconds,
                                      int64_t first_sequence) {
  return [&config, voltage, seconds, first_sequence](bus::Bus& bus, bus::Clock& clock) {
    const bus::Channels channels(config.bus.channel_suffix);
    int64_t sequence = first_sequence;
    bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t& state) {
      motor_command_t command{};
      command.utime = clock.Utime();
      command.tick = state.tick;
      command.session = bus.process()->session;
      command.sequence = sequence;
      sequence = SaturatingSum(sequence, 1);
      command.voltage = voltage;
      bus.Publish(channels.Of<motor_command_t>(), command);
    });
    const auto end = clock.Now() + bus::FromSeconds(seconds);
    while (clock.Now() < end) bus.HandleUntil(end);
    return 0;
  };
}

}  // namespace hydro::torture
