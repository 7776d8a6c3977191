// hydro-experiment NAME: the paper's experiments and figures.
#include <cstdio>
#include <filesystem>

#include "base/input_error.h"
#include "experiments/run_experiments.h"
#include "experiments/studies/experiment.h"
#include "settings/command_line.h"

namespace {

int List() {
  for (const hydro::experiments::Experiment& experiment : hydro::experiments::Experiments()) {
    std::printf("%-10s %s\n", experiment.name.c_str(), experiment.title.c_str());
  }
  std::printf("%-10s %s\n", "all", "all of them, and a report, index.html");
  return 0;
}

int Run(hydro::experiments::ExperimentRequest& request) {
  if (request.name.empty())
    throw hydro::InputError("NAME: found nothing, allowed one of those that --list prints");
  if (request.jobs < 1 || request.jobs > 64) {
    throw hydro::InputError("--jobs: found " + std::to_string(request.jobs) + ", allowed 1 to 64");
  }
  if (request.real_time) {
    request.options.run_stack = hydro::experiments::SeparateProcesses(
        std::filesystem::read_symlink("/proc/self/exe").parent_path(), request.folder + "/runs");
  }
  return hydro::experiments::RunExperiments(hydro::experiments::Experiments(), request, stdout, stderr);
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::CommandLine line(
      "hydro-experiment",
      "The paper's experiments and figures: NAME.json, NAME.csv and NAME.svg of each; for "
      "all of them, index.html, too.");
  line.AddExamples({"hydro-experiment fig10 --out out/fig10", "hydro-experiment all --out out/paper"},
                   "docs/experiments.md");
  hydro::experiments::ExperimentRequest request;
  request.name.clear();
  bool list = false;
  line.AddPositional("NAME", &request.name, "which one, or all", false);
  line.AddOption("-o,--out", &request.folder, "DIR where to write (out/experiments)");
  line.AddOption("--run", &request.options.measured_run,
                 "FILE a measured run to analyse (friction, leakage)");
  line.AddOption("--seed", &request.options.seed, "N of every noise (1)");
  line.AddFlag("--noise", &request.options.noise,
               "sensors as noisy as the paper's plots, in pictures of their own (fig4, fig5)");
  line.AddFlag("--real-time", &request.real_time, "run the stack as separate processes on the wall clock");
  line.AddOption("--jobs", &request.jobs, "N how many experiments at the same time (2)");
  line.AddFlag("--si", &request.si, "print figures in SI units");
  line.AddFlag("--list", &list, "print the names and end");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-experiment", [&] { return list ? List() : Run(request); });
}
