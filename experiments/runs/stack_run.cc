#include "experiments/runs/stack_run.h"

#include <stdexcept>
#include <string_view>

#include "bus/channels.h"
#include "runs/run_table.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"

namespace hydro::experiments {
namespace {

// Collects from the bus what ExportRun() needs of a log.
class Recording {
 public:
  void Take(const bus::RawMessage& message) {
    Keep(message, channels_.Of<state_t>(), log_.messages.states) ||
        Keep(message, channels_.Of<motor_command_t>(), log_.messages.motor_commands) ||
        Keep(message, channels_.Of<pressure_command_t>(), log_.messages.pressure_commands) ||
        Keep(message, channels_.Of<arm_reference_t>(), log_.messages.arm_references) ||
        Keep(message, channels_.Of<fault_t>(), log_.messages.faults) ||
        Keep(message, channels_.Of<run_description_t>(), log_.descriptions);
  }
  const runs::RunLog& log() const { return log_; }
  runs::RunLog& log() { return log_; }

 private:
  template <class Message>
  static bool Keep(const bus::RawMessage& message, const std::string& channel,
                   std::vector<Message>& messages) {
    if (message.channel != channel) return false;
    if (messages.emplace_back().decode(message.data, 0, static_cast<int>(message.size)) < 0) {
      throw std::logic_error("a message of our own on " + channel + " does not decode");
    }
    return true;
  }

  bus::Channels channels_;
  runs::RunLog log_;
};

}  // namespace

tables::Table RunStackInProcess(const StackSetup& setup) {
  settings::StackConfig config =
      settings::ParseStackConfig(setup.config, setup.name, setup.model, setup.name + " (model)");
  config.bus.channel_suffix.clear();
  Recording recording;
  recording.log().file = setup.name;
  const sim::SimulationResult result =
      sim::Simulate(config, [&](const bus::RawMessage& message) { recording.Take(message); });
  if (result.exit_code != 0) throw std::runtime_error(setup.name + ": the run failed: " + result.failure);
  return runs::ExportRun(recording.log());
}

}  // namespace hydro::experiments
