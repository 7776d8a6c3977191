// hydro-diagnose as a function: reads its files, makes the diagnosis, writes the report and prints a summary.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace hydro::diagnose {

struct DiagnoseRequest {
  std::vector<std::string> runs,
      held_out;  // files, or LOG#NAME for a joint of a limb (runs/measured/measured_run.h)
  std::string model, folder;
  std::string effects;                   // file; "": the whole catalogue may be named
  std::vector<std::string> own_effects;  // files of effects as text, tried beside the catalogue's
  std::string free;                      // comma-separated names; "": all that the runs identify
  std::string per_run;                   // comma-separated names; "": what differs most, if anything does
  int jobs = 1;
  int64_t seed = 1;
  double time_limit = 60;  // s
  bool si = false;
  bool check = false;  // only look at the recordings; no folder is needed
};

// The function that makes the diagnosis: Diagnose, or a stand-in for tests.
using Diagnoser =
    std::function<Diagnosis(const model::ModelDescription&, std::vector<runs::MeasuredRun>,
                            std::vector<runs::MeasuredRun>, const DiagnoseOptions&, const ProgressCallback&)>;

// Writes report.html, report.json, model.toml and, when there is a next experiment, next.toml into the
// request's folder, each file whole or not at all, and a summary to `out`. A folder that already has one of
// these files with contents is bad input, unless AllowReplacing() was called (base/new_file.h). Progress goes
// to `err`: a bar if that is a terminal, otherwise one line for each stage. No progress line appears before
// the input was found good, so that bad input leaves only its one-line error there. Throws InputError for
// anything that cannot be read or used, including a model that cannot follow a run.
void RunDiagnosis(const DiagnoseRequest& request, const Diagnoser& diagnose, std::FILE* out, std::FILE* err);

// Only looks at the recordings, and prints a line for each thing it finds. Returns the exit code: 0 when
// nothing is wrong with the recordings, otherwise 1. Throws InputError as above.
int CheckRuns(const DiagnoseRequest& request, std::FILE* out);

// Applies `joint` to each run that does not name a joint itself: LOG becomes LOG#NAME. Throws InputError for
// a table.
void ChooseJoint(const std::string& joint, DiagnoseRequest* request);

// Adds the effects in these files to the catalogue, before its first use. Throws InputError.
void AddOwnEffects(const std::vector<std::string>& files);

// Reads the ids in a file of effects: TOML, effects = ["pump.stribeck", ...]. Throws InputError for unknown
// ids or keys and for an empty list.
std::vector<std::string> ReadEffectList(const std::string& file);

// Splits the list of base parameters, such as "b,T_s", given to `option` ("--free"). Throws InputError for
// unknown or missing names.
std::vector<std::string> SplitNames(const std::string& option, const std::string& names);

}  // namespace hydro::diagnose
