// report.html: a diagnosis for a person, on a screen or on paper.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// One page that needs nothing else: pictures inline, no scripts, no time of day. Identical diagnoses give
// identical bytes. With `si`, figures are in SI.
std::string ReportHtml(const Diagnosis& diagnosis, bool si);

}  // namespace hydro::diagnose
