// The pictures of report.html.
#pragma once

#include <optional>

#include "diagnose/data/diagnosis.h"
#include "page/plot.h"

namespace hydro::diagnose {

// The gap before, with refitted parameters and after, in noise units, of all signals and of each.
page::Figure GapFigure(const Diagnosis& diagnosis);

// The signals of one run, measured and simulated before and after, and the residuals of each; the places of the
// disagreement are shaded. Nothing without time or curves.
std::optional<page::Figure> RunFigure(const Diagnosis& diagnosis, const RunCurves& run, bool si);

// The residuals of all runs before and after, a row for each signal, against speed, pressure difference, arm angle and
// voltage, where those were measured. Nothing without curves.
std::optional<page::Figure> DependenceFigure(const Diagnosis& diagnosis, bool si);

// The missing term of a balance against what it depends on.
page::Figure MissingTermFigure(const MissingTerm& term);

}  // namespace hydro::diagnose
