// hydro-tune CONFIG: finds gains for a model and goals.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "settings/command_line.h"
#include "tune/search/tune.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine line(
      "hydro-tune",
      "Proposes gains of both loops for a model and goals: margins by the exact linearisation, steps on the "
      "nonlinear model. Example: hydro-tune config/paper.toml --goal overshoot_percent=1 -o tuned.toml");
  line.AddExamples(
      {"hydro-tune config/demo.toml                          print margins and settling of proposed gains",
       "hydro-tune config/demo.toml -o tuned.toml --out out/tune    and write the configuration, and a "
       "report"},
      "docs/tuning_gains.md");
  hydro::tune::TuneRequest request;
  request.jobs = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
  line.AddPositional("CONFIG", &request.config, "FILE the stack's configuration (TOML)");
  line.AddOption(
      "--set", &request.overrides,
      "SECTION.KEY=VALUE changes one key of CONFIG, e.g. model.file=other.toml; -o writes it, too");
  line.AddOption(
      "--joint", &request.joint,
      "NAME of a configuration with [[joint]] sections, the joint to tune; -o then writes the stack of this "
      "joint alone");
  line.AddOption(
      "--goal", &request.goals,
      "NAME=VALUE bandwidth_hz, settling_s (within 2 %, of step), overshoot_percent, or step, the step "
      "to tune for, in the unit of the arm (0.1, \"5 deg\", \"30 mm\"); several may be given. Without a "
      "goal: as fast as the margins allow");
  line.AddOption("--interval", &request.interval,
                 "S the position loop's sampling interval T (the configuration's)");
  line.AddOption("-o,--output", &request.output,
                 "FILE where to write the configuration with the gains; - for the standard output");
  line.AddOption("--out", &request.folder, "DIR where to write the report: tune.html, tune.svg");
  line.AddOption("--samples", &request.samples,
                 "N of what may be true instead of the model, from [uncertainty] (8)");
  line.AddOption("--jobs", &request.jobs, "N threads (as many as processors)");
  line.AddForce();
  line.AddFlag("--fixed-gains", &request.fixed_gains, "eq. (17) alone, without a braking curve");
  line.AddFlag("--noise", &request.noise, "with noisy sensors");
  line.AddFlag("--si", &request.si, "show gains in SI units");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram(
      "hydro-tune", [&] { return hydro::tune::Tune(request, stdout, stderr, isatty(STDERR_FILENO) != 0); });
}
