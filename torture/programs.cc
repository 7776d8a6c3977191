#include "torture/programs.h"

#include <memory>

#include "bus/channels.h"
#include "logger/logger_app.h"
#include "plant/plant_app.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/app.h"
#include "torture/active_fault.h"
#include "torture/faulty_rig.h"
#include "torture/world.h"

namespace hydro::torture {
namespace {

using namespace std::chrono_literals;

constexpr auto kOperatorRepeats = 50ms;
constexpr auto kOperatorPatience = 400ms;

template <class Application>
SimulatedProcess::Body Running(const settings::StackConfig& config) {
  return [&config](bus::Bus& bus, bus::Clock& clock) {
    const auto app = std::make_unique<Application>(bus, clock, config);  // too large for a fiber's stack
    return process::RunApp(bus, clock, *app);
  };
}

}  // namespace

SimulatedProcess::Body ProgramOf(Role role, const settings::StackConfig& config, World& world, int number) {
  switch (role) {
    case Role::kPressure:
      return Running<pressure_ctrl::PressureApp>(config);
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
    default:
      return [&config, &world, number](bus::Bus& bus, bus::Clock& clock) {
        const std::vector<std::string> expected(world.has_logger() ? 1 : 0, "logger");
        FaultyRig rig(config, world.process(number), world.sensor_faults(), world.observer());
        const auto app = std::make_unique<plant::PlantApp>(bus, clock, config, rig, expected, "hydro-plant",
                                                           [&world] { return world.launcher_hangs() == 0; });
        return app->Run();
      };
  }
}

SimulatedProcess::Body RearmProgram(const settings::StackConfig& config, int64_t plant) {
  return [&config, plant](bus::Bus& bus, bus::Clock& clock) {
    const bus::Channels channels(config.bus.channel_suffix);
    int64_t tick = -1;
    bool answered = false;
    bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t& state) {
      if (state.session == plant) tick = state.tick;
    });
    bus.Subscribe<rearm_t>(channels.Of<rearm_t>(), [&](const rearm_t& answer) {
      answered = answered || (answer.kind != rearm_t::REQUEST && answer.addressee == bus.process()->session);
    });
    const auto end = clock.Now() + kOperatorPatience;
    while (!answered && clock.Now() < end) {
      for (const auto until = clock.Now() + kOperatorRepeats; !answered && clock.Now() < until;) {
        bus.HandleUntil(until);
      }
      rearm_t request{};
      request.utime = clock.Utime();
      request.tick = tick;
      request.session = bus.process()->session;
      request.addressee = plant;
      request.kind = rearm_t::REQUEST;
      request.source = "launch";
      request.text = "hydro-launch --rearm";
      if (!answered && tick >= 0) bus.Publish(channels.Of<rearm_t>(), request);
    }
    return 0;
  };
}

SimulatedProcess::Body InsiderProgram(const settings::StackConfig& config, double voltage, double seconds) {
  return [&config, voltage, seconds](bus::Bus& bus, bus::Clock& clock) {
    const bus::Channels channels(config.bus.channel_suffix);
    int64_t sequence = 0;
    bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t& state) {
      motor_command_t command{};
      command.utime = clock.Utime();
      command.tick = state.tick;
      command.session = bus.process()->session;
      command.sequence = sequence++;
      command.voltage = voltage;
      bus.Publish(channels.Of<motor_command_t>(), command);
    });
    const auto end = clock.Now() + bus::FromSeconds(seconds);
    while (clock.Now() < end) bus.HandleUntil(end);
    return 0;
  };
}

SimulatedProcess::Body StopProgram(const settings::StackConfig& config) {
  return [&config](bus::Bus& bus, bus::Clock& clock) {
    const bus::Channels channels(config.bus.channel_suffix);
    stop_t stop{};
    stop.tick = -1;
    stop.session = bus.process()->session;
    stop.addressee = 0;
    stop.source = "launch";
    stop.reason = "hydro-launch --stop";
    const auto end = clock.Now() + kOperatorPatience;
    while (clock.Now() < end) {
      stop.utime = clock.Utime();
      bus.Publish(channels.Of<stop_t>(), stop);
      for (const auto until = clock.Now() + kOperatorRepeats; clock.Now() < until;) bus.HandleUntil(until);
    }
    return 0;
  };
}

}  // namespace hydro::torture
