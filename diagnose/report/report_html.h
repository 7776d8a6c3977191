// report.html: a diagnosis for people, on a screen or on paper.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// One self-contained page: inline pictures, no scripts, no time of day. Identical diagnoses give identical
// bytes. With `si`, figures are in SI. `model_toml`: the model's file as written; empty: without comments.
std::string ReportHtml(const Diagnosis& diagnosis, bool si, const std::string& model_toml = "");

}  // namespace hydro::diagnose
