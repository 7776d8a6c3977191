// hydro-experiment NAME: the paper's experiments and figures.
#include "experiments/experiment.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  hydro::CommandLine command_line("hydro-experiment", "The paper's experiments and figures.");
  std::string name;
  command_line.AddPositional("NAME", &name, "which");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  return 0;
}
