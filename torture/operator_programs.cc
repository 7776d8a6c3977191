// The operator's requests as simulated processes: the launcher's own code (launch/logic).
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

}  // namespace

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
