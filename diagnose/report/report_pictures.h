// The pictures of report.html, of three kinds: a curve over the variable that it depends on, signals over
// time, and the gap by horizon.
#pragma once

#include <optional>
#include <string>

#include "diagnose/recording/diagnosis.h"
#include "page/plot.h"

namespace hydro::diagnose {

// Colours of the palette, with the same meaning throughout the report.
inline constexpr int kAfter = 0, kBefore = 1, kRefit = 5;

inline constexpr char kBeforeLabel[] = "model as given";
inline constexpr char kAfterLabel[] = "with what was found";

// Turns "pump_torque" into "pump torque".
std::string WithBlanks(std::string name);
// Returns "motor speed (rad/s)"; without parentheses where there is no unit.
std::string Label(const std::string& name, const std::string& unit);

// What balances measure, as points with 95 % intervals, and the models' values over the same variable. The
// picture is as high as the curves need; a wide interval at an end with few samples does not stretch it.
// `what` replaces the name of what is measured.
page::Figure CurveFigure(const MeasuredCurve& curve, const std::string& what = "");

// The gap at each horizon before, refitted and after, for held-out and fitted runs.
page::Figure HorizonFigure(const Diagnosis& diagnosis);

// The measured signals of one run with their simulations before and after, and the residuals of each. The
// windows of disagreement are shaded. Nothing if there is no time or there are no curves.
std::optional<page::Figure> RunFigure(const Diagnosis& diagnosis, const RunCurves& run, bool si);

// A stretch of a run with an effect and without it.
page::Figure StretchFigure(const FoundStretch& stretch, const UnitSystem& units, bool si);

}  // namespace hydro::diagnose
