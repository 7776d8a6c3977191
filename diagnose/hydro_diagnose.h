// hydro-diagnose as a function: reads its files, has the diagnosis made, writes and tells it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace hydro::diagnose {

struct DiagnoseRequest {
  std::vector<std::string> runs, held_out;  // files
  std::string model, folder;
  std::string effects;  // file; "": the whole catalogue may be named
  std::string free;     // names with commas; "": all that the runs identify
  int jobs = 1;
  int64_t seed = 1;
  bool si = false;
};

// What makes the diagnosis: Diagnose, or another in tests.
using Diagnoser =
    std::function<Diagnosis(const model::ModelDescription&, std::vector<runs::MeasuredRun>,
                            std::vector<runs::MeasuredRun>, const DiagnoseOptions&, const TellProgress&)>;

// Writes report.html, report.json, model.toml and, when there is a next experiment, next.toml into the
// request's folder, each whole or not at all, and a summary to `out`. Progress goes to `err` where that is a
// terminal, as a bar, else to `out`, a line a stage: `err` is for the one line of an error. Throws InputError
// for what cannot be read or used, a model that cannot follow a run included.
void RunDiagnosis(const DiagnoseRequest& request, const Diagnoser& diagnose, std::FILE* out, std::FILE* err);

// The ids that a file of effects names: TOML, effects = ["pump.stribeck", ...]. Throws InputError for unknown
// ids and keys, and when there are none.
std::vector<std::string> ReadEffectList(const std::string& file);

// The base parameters in "b,T_s". Throws InputError for names that are unknown or missing.
std::vector<std::string> SplitFree(const std::string& names);

}  // namespace hydro::diagnose
