// hydro-torture: runs the whole stack in simulation, under faults drawn from a seed.
#include "process/stop_signal.h"
#include "settings/command_line.h"
#include "sim/torture/torture_command.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-torture",
                                    "The whole stack in simulation, under faults drawn from a seed.");
  line.AddExamples({"hydro-torture --runs 100 --seed 1"}, "docs/developers/torture.md");
  hydro::torture::TortureOptions options;
  hydro::torture::AddOptions(&line, &options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-torture", [&] {
    hydro::process::CatchStopSignals();  // Ctrl-C gives the report so far
    return hydro::torture::Run(options);
  });
}
