#include "experiments/runs/stack_run.h"

#include <stdexcept>
#include <string_view>

#include "bus/channels.h"
#include "runs/run_table.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"

namespace hydro {
namespace {

// What ExportRun() needs of a log, taken from the bus instead.
class Recording {
 public:
  void Take(const RawMessage& message) {
    Keep(message, channels_.state, log_.messages.states) ||
        Keep(message, channels_.motor_command, log_.messages.motor_commands) ||
        Keep(message, channels_.pressure_command, log_.messages.pressure_commands) ||
        Keep(message, channels_.arm_reference, log_.messages.arm_references) ||
        Keep(message, channels_.fault, log_.messages.faults) ||
        Keep(message, channels_.run, log_.descriptions);
  }
  const RunLog& log() const { return log_; }
  RunLog& log() { return log_; }

 private:
  template <class Message>
  static bool Keep(const RawMessage& message, const std::string& channel, std::vector<Message>& messages) {
    if (message.channel != channel) return false;
    if (messages.emplace_back().decode(message.data, 0, static_cast<int>(message.size)) < 0) {
      throw std::logic_error("a message of our own on " + channel + " does not decode");
    }
    return true;
  }

  Channels channels_;
  RunLog log_;
};

}  // namespace

Table RunStackInProcess(const StackSetup& setup) {
  StackConfig config = ParseStackConfig(setup.config, setup.name, setup.model, setup.name + " (model)");
  config.bus.channel_suffix.clear();
  Recording recording;
  recording.log().file = setup.name;
  const SimulationResult result =
      Simulate(config, [&](const RawMessage& message) { recording.Take(message); });
  if (result.exit_code != 0) throw std::runtime_error(setup.name + ": the run failed: " + result.failure);
  return ExportRun(recording.log());
}

}  // namespace hydro
