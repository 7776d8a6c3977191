// The operator's requests as simulated processes, which run the launcher's own code (launch/logic).
#include "sim/torture/programs.h"

#include <array>
#include <cmath>
#include <hydro/arm_plan_t.hpp>
#include <hydro/state_t.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include "base/integers.h"
#include "bus/channels.h"
#include "launch/logic/operator_request.h"
#include "logger/logger_app.h"
#include "plant/plant_app.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/app.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/faulty_rig.h"
#include "sim/torture/world.h"
#include "tune/live/tuning_client.h"

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

using namespace std::chrono_literals;

// The operator's machine runs no process of a stack.
class NoLocalProcesses : public launch::LocalProcesses {
 public:
  int found() const override { return 0; }
  bool Found(int /*pid*/) const override { return false; }
  std::string Left() override { return ""; }
};

// Gains, limits and a reference, and two changes that are refused: loops that would be unstable, and a limit
// that would be loosened. Empty: undo.
constexpr std::array kChanges{"position.c2=900\nposition.c1=4000",
                              "pressure.damping_ratio=0.7",
                              "limits.arm_angle_rad=0.5",
                              "reference.amplitude=0.1",
                              "",
                              "position.c1=1e6",
                              "limits.pressure_psi=1e6",
                              "limits.pressure_psi=1800"};

// A plan for the next moments from this state on, along a sine with the stack's own amplitude and period.
arm_plan_t PlanFrom(const state_t& state) {
  constexpr int kPoints = 8;
  constexpr double kInterval_s = 0.05, kAmplitude_rad = 0.2, kFrequency_rad_s = 2 * std::numbers::pi * 0.25;
  arm_plan_t plan{};
  plan.tick = state.tick;
  plan.count = kPoints;
  for (int i = 0; i < kPoints; ++i) {
    const double time = state.time + kInterval_s * i;
    plan.time.push_back(time);
    plan.arm_angle.push_back(kAmplitude_rad * std::sin(kFrequency_rad_s * time));
    plan.arm_speed.push_back(kAmplitude_rad * kFrequency_rad_s * std::cos(kFrequency_rad_s * time));
    plan.torque.push_back(0);
  }
  return plan;
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

SimulatedProcess::Body SetProgram(const settings::StackConfig& config, int which) {
  return [&config, which](bus::Bus& bus, bus::Clock& clock) {
    tuning::TuningClient client(bus, clock, bus::Channels(config.bus.channel_suffix), "hydro-set");
    const auto wait = [&](bus::Clock::Duration longest, const auto& until) {
      const auto deadline = clock.Now() + longest;
      while (!until() && clock.Now() < deadline) {
        bus.HandleUntil(clock.Now() + 20ms);
        client.Poll();
      }
      return until();
    };
    if (!wait(3s, [&] { return client.in_force() && client.plants().size() == 1; })) return 1;
    const std::string changes = kChanges.at(static_cast<size_t>(which) % kChanges.size());
    changes.empty() ? client.Undo() : client.Set(changes);
    std::optional<tuning_answer_t> answer;
    wait(4s, [&] { return answer || (answer = client.TakeAnswer()).has_value(); });
    return answer && answer->accepted != 0 ? 0 : 1;
  };
}

SimulatedProcess::Body PlannerProgram(const settings::StackConfig& config) {
  return [&config](bus::Bus& bus, bus::Clock& clock) {
    constexpr int64_t kPlanTicks = 20;
    const bus::Channels channels(config.bus.channel_suffix);
    int64_t sequence = 0;
    bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t& state) {
      if (state.tick % kPlanTicks != 0 || !(std::fabs(state.time) < 1e6)) return;
      arm_plan_t plan = PlanFrom(state);
      plan.utime = clock.Utime();
      plan.session = bus.process()->session;
      plan.sequence = sequence++;
      bus.Publish(channels.Of<arm_plan_t>(), plan);
    });
    while (bus.process()->stop_signal == 0) bus.HandleUntil(clock.Now() + 1s);
    return 0;
  };
}

SimulatedProcess::Body RearmProgram(const settings::StackConfig& config) {
  return [&config](bus::Bus& bus, bus::Clock& clock) {
    return launch::RearmStack(bus, clock, config).exit_code;
  };
}

SimulatedProcess::Body StopProgram(const settings::StackConfig& config, bool watched) {
  launch::OperatorTiming timing;
  if (watched) timing = {.presence = 400ms, .end = 400ms, .quiet = 100ms};
  return [&config, timing](bus::Bus& bus, bus::Clock& clock) {
    NoLocalProcesses none;
    return launch::StopOverBus(bus, clock, config, none, timing).exit_code;
  };
}

}  // namespace hydro::torture
