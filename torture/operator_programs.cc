// The operator's requests as simulated processes: the launcher's own code (launch/logic).
#include <array>
#include <optional>
#include <string>

#include "hydro_set/tuning_client.h"
#include "launch/logic/operator_request.h"
#include "torture/programs.h"

namespace hydro::torture {
namespace {

using namespace std::chrono_literals;

// The operator's machine runs no process of a stack.
class NoLocalProcesses : public launch::LocalProcesses {
 public:
  int found() const override { return 0; }
  bool Found(int /*pid*/) const override { return false; }
  std::string Left() override { return ""; }
};

// Gains, limits and a reference; loops that would be unstable and a limit that would be loosened, which are
// refused. Empty: undo.
constexpr std::array kChanges{"position.c2=900\nposition.c1=4000",
                              "pressure.damping_ratio=0.7",
                              "limits.arm_angle_rad=0.5",
                              "reference.amplitude=0.1",
                              "",
                              "position.c1=1e6",
                              "limits.pressure_psi=1e6",
                              "limits.pressure_psi=1800"};

}  // namespace

SimulatedProcess::Body SetProgram(const settings::StackConfig& config, int which) {
  return [&config, which](bus::Bus& bus, bus::Clock& clock) {
    hydro_set::TuningClient client(bus, clock, bus::Channels(config.bus.channel_suffix), "hydro-set");
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
