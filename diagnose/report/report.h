// Writes a diagnosis: report.html for people, on screen or paper; report.json for programs; model.toml with
// what was found beside its values; and about ten lines for a terminal.
#pragma once

#include <string>

#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The verdict as reports write it: "named", "tied", ...
const std::string& VerdictName(Verdict verdict);

// One self-contained page: inline pictures, no scripts, no time of day. Identical diagnoses give identical
// bytes. With `si`, figures are in SI. `model_toml` is the text of the model's file; if empty, the page has
// none of its comments.
std::string ReportHtml(const Diagnosis& diagnosis, bool si, const std::string& model_toml = "");

// docs/gap_report.md describes the keys. `next_config` names the file of the next experiment, "" when there
// is none. Non-finite values become null.
std::string ReportJson(const Diagnosis& diagnosis, const std::string& next_config, double elapsed_s);

// `folder` contains the report. With `si`, figures are in SI.
std::string TerminalSummary(const Diagnosis& diagnosis, const std::string& folder, bool si);

// The text of model.toml: what settings::FormatModel writes, with a comment at each value that differs from
// `given`: its 95 % interval, its origin and its former value. The text reads back as the same description.
std::string CommentedModel(const Diagnosis& diagnosis, const model::ModelDescription& given);

// "b 0.0203 [0.0199, 0.0207] in-lbf-s"
std::string WithInterval(const Estimated& estimated);

// "Cannot be judged from these runs: valve.relief and line.wave, because p1 and p2 were not recorded"
std::string UnjudgedText(const Unjudged& unjudged);

// What an explanation changes, in words: "pump.stribeck + another value of b", "no effect (other values at
// most)".
std::string InWords(const WeightedSet& explanation);

}  // namespace hydro::diagnose
