// hydro-batch STUDY.toml: runs many cases of one thing, with other values in each.
#include "batch/batch_command.h"
#include "process/stop_signal.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine line(
      "hydro-batch", "Many cases of one thing, with other values in each: a table and a page.");
  line.AddExamples(
      {"hydro-batch examples/studies/position_gains.toml", "hydro-batch --status out/batch/position_gains"},
      "docs/studies.md");
  hydro::batch::BatchOptions options;
  hydro::batch::AddOptions(&line, &options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-batch", [&] {
    hydro::process::CatchStopSignals();
    return hydro::batch::Run(options);
  });
}
