#include "experiments/runs/stack_run.h"

#include <stdexcept>

#include "bus/channels.h"
#include "runs/run_table.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"

namespace hydro::experiments {
namespace {

// Collects the messages of a run from the bus.
class Recording {
 public:
  void Take(const bus::RawMessage& message) {
    bus::AnyMessage([&]<class Message>(const bus::MessageRow<Message>&) {
      if (message.channel != channels_.Of<Message>()) return false;
      if (log_.messages.Of<Message>().emplace_back().decode(message.data, 0, message.size) < 0) {
        throw std::logic_error("a message of our own on " + channels_.Of<Message>() + " does not decode");
      }
      return true;
    });
  }
  const runs::RunLog& log() const { return log_; }
  runs::RunLog& log() { return log_; }

 private:
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
