// hydro-sim CONFIG -o FILE: plant, pressure loop, position loop and logger in one process on a simulated
// clock.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "process/stop_signal.h"
#include "runs/log/log_writer.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/tuning_history.h"
#include "settings/command_line.h"
#include "settings/joint_documents.h"
#include "settings/model_file.h"
#include "settings/process_sections.h"
#include "sim/simulation.h"
#include "tune/design/fastest_motion.h"

namespace {

// A simulation on a simulated clock cannot wait for another process. A warning says what it runs instead, and
// the log's configuration records it.
hydro::settings::StackConfig WithOurPrograms(const hydro::settings::StackConfig& config) {
  for (const hydro::settings::ProcessSection& process : config.processes) {
    if (process.command.empty()) continue;
    const bool driver = process.role == "driver";  // the model stands for any machine
    hydro::Remark("hydro-sim: warning: " + process.place + ": " + hydro::settings::NameOf(process) +
                  " is a program of your own; the simulation runs our " + (driver ? "model" : process.role) +
                  " in its place, `hydro-launch " + config.file + (driver ? "" : " --time lockstep") +
                  "` runs yours");
  }
  return hydro::settings::WithoutOwnPrograms(config);
}

// Loads the simulated machine. It must be in the units of the model that the controllers know, because states
// and commands are in those units.
hydro::model::ModelDescription LoadMachine(const std::string& file,
                                           const hydro::settings::StackConfig& config) {
  hydro::model::ModelDescription machine = hydro::settings::LoadModelFile(file);
  if (machine.units != config.model.description.units) {
    throw hydro::InputError(file + ": units: found others than those of " + config.model.resolved_file +
                            ", allowed the same");
  }
  return machine;
}

bool IsWholeLimb(const hydro::settings::CommonOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  return !hydro::settings::TakeJointChoice(&overrides) && hydro::settings::IsLimbFile(options.config);
}

// A simulation that is given the destination of its messages.
using Simulation = std::function<hydro::sim::SimulationResult(
    const std::function<void(const hydro::bus::RawMessage&)>& tap)>;

void Warn(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) hydro::Remark("hydro-sim: warning: " + remark);
}

// A change that never acts is hardly what was asked for.
void WarnOfUnused(const std::vector<hydro::tuned_settings_t>& tunings, const std::string& file,
                  int64_t last_tick) {
  const auto late = std::count_if(tunings.begin(), tunings.end(),
                                  [&](const auto& settings) { return settings.acts_at > last_tick; });
  if (tunings.empty()) {
    Warn({file + ": found no change of values, so --tuning changes nothing"});
  } else if (last_tick >= 0 && late > 0) {
    Warn({file + ": " + std::to_string(late) + " of " + std::to_string(tunings.size()) +
          " changes act after tick " + std::to_string(last_tick) + ", the last of this run (--duration)"});
  }
}

Simulation SimulationOf(const hydro::settings::CommonOptions& options, const std::string& tunings_of,
                        const std::string& machine_file) {
  if (IsWholeLimb(options)) {
    for (const auto& [option, given] : {std::pair("--tuning", tunings_of), {"--machine", machine_file}}) {
      if (given.empty()) continue;
      throw hydro::InputError(std::string(option) +
                              ": found it with joints, allowed is one joint's stack (--joint NAME)");
    }
    const auto limb = std::make_shared<const hydro::settings::LimbConfig>(
        hydro::settings::LoadLimbConfig(options.config, options.overrides));
    Warn(hydro::design::RemarksOn(*limb));
    return [limb](const auto& tap) { return hydro::sim::SimulateLimb(*limb, tap); };
  }
  const auto config = std::make_shared<const hydro::settings::StackConfig>(
      WithOurPrograms(hydro::settings::LoadStackConfig(options.config, options.overrides)));
  Warn(hydro::design::RemarksOn(*config));
  std::vector<hydro::tuned_settings_t> tunings;
  if (!tunings_of.empty()) {
    std::vector<std::string> overrides = options.overrides;
    const auto joint = hydro::settings::TakeJointChoice(&overrides);
    tunings = hydro::runs::TuningHistory(hydro::runs::ReadRunLog(tunings_of, {.joint = joint}).messages);
    WarnOfUnused(tunings, tunings_of, config->last_tick);
  }
  std::shared_ptr<const hydro::model::ModelDescription> machine;
  if (!machine_file.empty()) {
    machine = std::make_shared<const hydro::model::ModelDescription>(LoadMachine(machine_file, *config));
  }
  hydro::sim::CheckSimulates(*config, machine.get());
  return [config, tunings, machine](const auto& tap) {
    return hydro::sim::Simulate(*config, tap, tunings, machine.get());
  };
}

int Run(const hydro::settings::CommonOptions& options, const std::string& file, const std::string& tunings_of,
        const std::string& machine_file) {
  const Simulation simulate = SimulationOf(options, tunings_of, machine_file);
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
  hydro::SayRemarks();
  const auto start = std::chrono::steady_clock::now();
  const hydro::sim::SimulationResult result = simulate(tap);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (writer) writer->Finish();
  const bool held = result.exit_code == 0 && !result.faults_left.empty();
  for (const std::string& line : result.fault_lines) std::printf("%s\n", hydro::Printable(line).c_str());
  if (!result.failure.empty()) std::fprintf(stderr, "hydro-sim: %s\n", result.failure.c_str());
  if (const int signal = hydro::process::StopSignal(); signal != 0) {
    const std::string what = file.empty() ? "the run ends" : "the run and its log " + file + " end";
    std::fprintf(stderr, "hydro-sim: stopped by signal %d: %s after %s s of plant time\n", signal,
                 hydro::Printable(what).c_str(), hydro::ShortNumber(result.duration, 6).c_str());
  }
  std::printf("%lld ticks, %s s of plant time in %s s, %s times real time\n",
              static_cast<long long>(result.ticks), hydro::ShortNumber(result.duration, 6).c_str(),
              hydro::ShortNumber(wall, 3).c_str(), hydro::ShortNumber(result.duration / wall, 3).c_str());
  if (held) std::fprintf(stderr, "hydro-sim: %s\n", result.faults_left.c_str());
  return held ? 1 : result.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line("hydro-sim",
                                            "The whole stack in one process on a simulated clock.");
  command_line.AddExamples({"hydro-sim config/demo.toml -o run.lcmlog"}, "README.md");
  hydro::settings::CommonOptions options;
  std::string file, tunings_of, machine;
  command_line.AddCommon(&options);
  command_line.AddOption(
      "-o,--output", &file,
      "FILE where to record the run; short for --log. Without either, nothing is recorded");
  command_line.AddOption("--tuning", &tunings_of,
                         "LOG change values as was done in that run (hydro-set), at the same ticks");
  command_line.AddOption("--machine", &machine,
                         "MODEL simulate this machine, under controllers that know that of CONFIG");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return hydro::settings::RunProgram("hydro-sim", [&] {
    return Run(options, hydro::settings::FileToRecord(file, options.log), tunings_of, machine);
  });
}
