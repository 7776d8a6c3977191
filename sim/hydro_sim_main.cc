// hydro-sim CONFIG -o FILE: plant, pressure loop, position loop and logger in one process on a simulated
// clock.
#include <chrono>
#include <cstdio>
#include <memory>

#include "base/read_files.h"
#include "log/log_writer.h"
#include "process/stop_signal.h"
#include "settings/command_line.h"
#include "sim/simulation.h"

namespace {

int Run(const hydro::settings::CommonOptions& options, const std::string& file) {
  const hydro::settings::StackConfig config =
      hydro::settings::LoadStackConfig(options.config, options.overrides);
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
  const hydro::sim::SimulationResult result = hydro::sim::Simulate(config, tap);
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
  hydro::settings::CommonOptions options;
  std::string file;
  command_line.AddCommon(&options);
  command_line.AddOption(
      "-o,--output", &file,
      "FILE where to record the run; short for --log. Without either, nothing is recorded");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return hydro::settings::RunProgram(
      "hydro-sim", [&] { return Run(options, hydro::settings::FileToRecord(file, options.log)); });
}
