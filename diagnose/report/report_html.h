// report.html: a diagnosis for people, on a screen or on paper.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// One self-contained page: inline pictures, no scripts, no time of day. Identical diagnoses give identical
// bytes. With `si`, figures are in SI.
std::string ReportHtml(const Diagnosis& diagnosis, bool si);

}  // namespace hydro::diagnose
