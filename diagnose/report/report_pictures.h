// The pictures of report.html, each an SVG element in a <figure>.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// The gap before, with refitted parameters and after, in noise units, of all signals and of each.
std::string GapPicture(const Diagnosis& diagnosis);

// Measured against before and after, and what is left of each, of one run; the places of the disagreement
// are shaded.
std::string RunPicture(const Diagnosis& diagnosis, const RunCurves& run, bool si);

// What is left before and after of all runs, a row each signal, against speed, pressure difference, arm angle
// and voltage, where those are there; "" without curves.
std::string DependencePicture(const Diagnosis& diagnosis, bool si);

// The missing term of a balance against what it depends on.
std::string MissingTermPicture(const MissingTerm& term);

}  // namespace hydro::diagnose
