// hydro-sim CONFIG -o FILE: plant, pressure loop, position loop and logger in one process on a simulated
// clock.
#include <chrono>
#include <cstdio>
#include <memory>

#include "base/read_files.h"
#include "base/text_file.h"
#include "log/log_writer.h"
#include "process/stop_signal.h"
#include "runs/run_log.h"
#include "runs/tuning_history.h"
#include "settings/command_line.h"
#include "settings/joint_documents.h"
#include "settings/process_sections.h"
#include "sim/simulation.h"

namespace {

// A simulation on a simulated clock cannot wait for another process. What it runs instead is said, and stands in the log's
// configuration.
hydro::settings::StackConfig WithOurPrograms(const hydro::settings::StackConfig& config) {
  for (const hydro::settings::ProcessSection& process : config.processes) {
    if (process.command.empty()) continue;
    std::fprintf(stderr,
                 "hydro-sim: warning: %s: %s is a program of your own; the simulation runs our %s in its "
                 "place, `hydro-launch %s --time lockstep` runs yours\n",
                 hydro::Printable(process.place).c_str(),
                 hydro::Printable(hydro::settings::NameOf(process)).c_str(), process.role.c_str(),
                 hydro::Printable(config.file).c_str());
  }
  return hydro::settings::WithoutOwnPrograms(config);
}

bool IsWholeLimb(const hydro::settings::CommonOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  return !hydro::settings::TakeJointChoice(&overrides) && hydro::settings::IsLimbFile(options.config);
}

// What is simulated, given where its messages go.
using Simulation = std::function<hydro::sim::SimulationResult(
    const std::function<void(const hydro::bus::RawMessage&)>& tap)>;

Simulation SimulationOf(const hydro::settings::CommonOptions& options, const std::string& tunings_of) {
  if (IsWholeLimb(options)) {
    if (!tunings_of.empty()) {
      throw hydro::InputError("--tuning: found it with joints, allowed is one joint's stack (--joint NAME)");
    }
    const auto limb = std::make_shared<const hydro::settings::LimbConfig>(
        hydro::settings::LoadLimbConfig(options.config, options.overrides));
    return [limb](const auto& tap) { return hydro::sim::SimulateLimb(*limb, tap); };
  }
  const auto config = std::make_shared<const hydro::settings::StackConfig>(
      WithOurPrograms(hydro::settings::LoadStackConfig(options.config, options.overrides)));
  std::vector<hydro::tuned_settings_t> tunings;
  if (!tunings_of.empty()) {
    std::vector<std::string> overrides = options.overrides;
    const auto joint = hydro::settings::TakeJointChoice(&overrides);
    tunings = hydro::runs::TuningHistory(hydro::runs::ReadRunLog(tunings_of, {.joint = joint}).messages);
  }
  return [config, tunings](const auto& tap) { return hydro::sim::Simulate(*config, tap, tunings); };
}

int Run(const hydro::settings::CommonOptions& options, const std::string& file,
        const std::string& tunings_of) {
  const Simulation simulate = SimulationOf(options, tunings_of);
  hydro::CheckKeeps(file);
  hydro::process::CatchStopSignals();
  std::unique_ptr<hydro::log::LogWriter> writer;
  if (!file.empty()) writer = std::make_unique<hydro::log::LogWriter>(file, hydro::Opening::kTemporary);
  std::function<void(const hydro::bus::RawMessage&)> tap;
  if (writer) {
    tap = [&](const hydro::bus::RawMessage& m) {
      writer->Append(m.channel, m.data, static_cast<size_t>(m.size), m.receive_utime);
    };
  }
  const auto start = std::chrono::steady_clock::now();
  const hydro::sim::SimulationResult result = simulate(tap);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (writer) writer->Finish();
  if (!result.failure.empty()) std::fprintf(stderr, "hydro-sim: %s\n", result.failure.c_str());
  std::printf("%lld ticks, %.6g s of plant time in %.3g s, %.3g times real time\n",
              static_cast<long long>(result.ticks), result.duration, wall, result.duration / wall);
  return result.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line("hydro-sim",
                                            "The whole stack in one process on a simulated clock.");
  command_line.AddExamples({"hydro-sim config/demo.toml -o run.lcmlog"}, "README.md");
  hydro::settings::CommonOptions options;
  std::string file, tunings_of;
  command_line.AddCommon(&options);
  command_line.AddOption(
      "-o,--output", &file,
      "FILE where to record the run; short for --log. Without either, nothing is recorded");
  command_line.AddOption("--tuning", &tunings_of,
                         "LOG change values as was done in that run (hydro-set), at the same ticks");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return hydro::settings::RunProgram("hydro-sim", [&] {
    return Run(options, hydro::settings::FileToRecord(file, options.log), tunings_of);
  });
}
