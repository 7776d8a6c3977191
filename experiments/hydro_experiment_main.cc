// hydro-experiment NAME: the paper's experiments and figures.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/input_error.h"
#include "experiments/run_experiments.h"
#include "experiments/studies/experiment.h"
#include "settings/command_line.h"

namespace {

constexpr int kMostJobs = 64;

int List() {
  for (const hydro::experiments::Experiment& experiment : hydro::experiments::Experiments()) {
    std::printf("%-17s %s\n", experiment.name.c_str(), experiment.title.c_str());
  }
  std::printf("%-17s %s\n", "all", "all of them, and a report, index.html");
  return 0;
}

int Run(hydro::experiments::ExperimentRequest& request) {
  if (request.name.empty())
    throw hydro::InputError("NAME: found nothing, allowed one of those that --list prints");
  if (request.jobs < 1 || request.jobs > kMostJobs) {
    throw hydro::InputError("--jobs: found " + std::to_string(request.jobs) + ", allowed 1 to " +
                            std::to_string(kMostJobs));
  }
  if (request.options.machines < 20 || request.options.machines > 1000000) {
    throw hydro::InputError("--machines: found " + std::to_string(request.options.machines) +
                            ", allowed 20 to 1000000");
  }
  if (request.options.seed < 0) {
    throw hydro::InputError("--seed: found " + std::to_string(request.options.seed) +
                            ", allowed a whole number of at least 0");
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
  request.jobs = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostJobs);
  bool list = false;
  line.AddPositional("NAME", &request.name, "which one, or all", false);
  line.AddOption("-o,--out", &request.folder, "DIR where to write (out/experiments)");
  line.AddForce();
  line.AddOption("--run", &request.options.measured_run,
                 "FILE a measured run to analyse (friction, leakage)");
  line.AddOption("--seed", &request.options.seed, "N of every noise, and of drawn machines (1)");
  line.AddOption("--machines", &request.options.machines,
                 "N drawn from what is known of Table 1 (10000; fig10_uncertainty)");
  line.AddFlag("--noise", &request.options.noise,
               "sensors as noisy as the paper's plots, in pictures of their own (fig4, fig5)");
  line.AddFlag("--real-time", &request.real_time, "run the stack as separate processes on the wall clock");
  line.AddOption("--jobs", &request.jobs, "N processors to use (all of them)");
  line.AddFlag("--si", &request.si, "print the tables in SI units; the text keeps those of the paper");
  line.AddFlag("--list", &list, "print the names and end");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-experiment", [&] { return list ? List() : Run(request); });
}
