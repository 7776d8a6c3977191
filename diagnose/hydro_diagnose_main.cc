// hydro-diagnose RUN...: finds and names what the model lacks, adds it, and proves it on held-out runs.
#include <algorithm>
#include <cstdio>
#include <thread>

#include "diagnose/hydro_diagnose.h"
#include "settings/command_line.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine line(
      "hydro-diagnose",
      "Finds where a model and measured runs disagree, names the missing effect, adds it "
      "to the model and shows the gap shrink on data it was not fitted to.");
  line.AddExamples({"hydro-diagnose run1.lcmlog run2.lcmlog --model config/models/table1.toml --out out/gap",
                    "hydro-diagnose run.csv --model config/models/table1.toml --check"},
                   "docs/gap_finder.md");
  hydro::diagnose::DiagnoseRequest request;
  request.jobs = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 256u));
  line.AddPositional(
      "RUN", &request.runs,
      "FILE a measured run: a log, or a table (csv, mat) with a sidecar; LOG#NAME: the joint NAME of a "
      "limb");
  line.AddOption("--model", &request.model, "MODEL the model as it is, TOML", true);
  line.AddOption(
      "-o,--out", &request.folder,
      "DIR where report.html, report.json, model.toml and next.toml are written; required without --check");
  line.AddForce();
  line.AddOption("--hold-out", &request.held_out,
                 "RUN a run that is not fitted, for the proof; without any, the runs are held out in turn");
  std::string joint;
  line.AddOption("--joint", &joint,
                 "NAME the joint of a limb that is meant in each log that names none itself");
  line.AddOption(
      "--effect", &request.own_effects,
      "FILE an effect of your own, written as text, to be looked for beside the others (repeatable)");
  line.AddOption("--effects", &request.effects,
                 "FILE the effects that may be named: TOML, effects = [\"pump.stribeck\", ...] (all)");
  line.AddOption("--free", &request.free,
                 "NAME,... base parameters that may be refitted (all that the runs identify)");
  line.AddOption(
      "--per-run", &request.per_run,
      "NAME,... base parameters whose values belong to a run (the one that differs most, if one does)");
  line.AddOption("--jobs", &request.jobs, "N how much is computed at the same time (the processors)");
  line.AddOption("--time-limit", &request.time_limit,
                 "S after which the search ends with what it has, in seconds (60)");
  line.AddOption("--seed", &request.seed, "N of all that is random (1)");
  line.AddFlag("--si", &request.si, "print figures in SI units, in report.html too");
  line.AddFlag("--check", &request.check,
               "look at the recordings only: 0 nothing is wrong with them, 1 something is");
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-diagnose", [&] {
    if (!joint.empty()) hydro::diagnose::ChooseJoint(joint, &request);
    hydro::diagnose::AddOwnEffects(request.own_effects);
    if (request.check) return hydro::diagnose::CheckRuns(request, stdout);
    hydro::diagnose::RunDiagnosis(request, hydro::diagnose::Diagnose, stdout, stderr);
    return 0;
  });
}
