// The pictures of report.html.
#pragma once

#include <optional>

#include "diagnose/data/diagnosis.h"
#include "page/plot.h"

namespace hydro::diagnose {

// The gap before, with refitted parameters, and after, in noise units: overall and for each signal.
page::Figure GapFigure(const Diagnosis& diagnosis);

// The signals of one run, measured and simulated before and after, and the residuals of each; the windows of
// disagreement are shaded. Nothing if there is no time or there are no curves.
std::optional<page::Figure> RunFigure(const Diagnosis& diagnosis, const RunCurves& run, bool si);

// The residuals of all runs before and after, one row a signal, against speed, pressure difference, arm angle
// and voltage, where those were measured. Nothing if there are no curves.
std::optional<page::Figure> DependenceFigure(const Diagnosis& diagnosis, bool si);

// The gap at each horizon before, refitted and after, held out and fitted.
page::Figure HorizonFigure(const Diagnosis& diagnosis);

// The term of an effect over its own variable: what the balance lacks without it, and the effect's own.
page::Figure FoundTermFigure(const FoundTerm& term);

// A stretch of a run with an effect and without it.
page::Figure StretchFigure(const FoundStretch& stretch, const UnitSystem& units, bool si);

// The missing term of a balance against what it depends on.
page::Figure MissingTermFigure(const MissingTerm& term);

}  // namespace hydro::diagnose
