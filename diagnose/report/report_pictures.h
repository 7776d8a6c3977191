// The pictures of report.html. There are three kinds: a curve over what it depends on, signals over time, and the gap by signal or
// horizon.
#pragma once

#include <optional>
#include <string>

#include "diagnose/recording/diagnosis.h"
#include "page/plot.h"
#include "page/range.h"

namespace hydro::diagnose {

// Colours of the palette; they mean the same throughout the report.
inline constexpr int kAfter = 0, kBefore = 1, kRefit = 5;

inline constexpr char kBeforeLabel[] = "model as given";
inline constexpr char kAfterLabel[] = "with what was found";

// "pump torque" for "pump_torque".
std::string WithBlanks(std::string name);
// "motor speed (rad/s)"; without brackets where there is no unit.
std::string Label(const std::string& name, const std::string& unit);

// What balances measure, as points with 95 % intervals, and what models have there over them. As high as the curves need, and not as
// an interval at an end that few samples reach. `what`: instead of the name of what is measured.
page::Figure CurveFigure(const MeasuredCurve& curve, const std::string& what = "");

// The gap before, with refitted parameters, and after, in noise units: overall and for each signal.
page::Figure GapFigure(const Diagnosis& diagnosis);

// The gap at each horizon before, refitted and after, held out and fitted.
page::Figure HorizonFigure(const Diagnosis& diagnosis);

// The signals of one run, measured and simulated before and after, and the residuals of each; the windows of
// disagreement are shaded. Nothing if there is no time or there are no curves.
std::optional<page::Figure> RunFigure(const Diagnosis& diagnosis, const RunCurves& run, bool si);

// A stretch of a run with an effect and without it.
page::Figure StretchFigure(const FoundStretch& stretch, const UnitSystem& units, bool si);

}  // namespace hydro::diagnose
