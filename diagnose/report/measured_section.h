// The page's section on what the balances measure of the machine itself: friction, leakage, load.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"
#include "page/plot.h"

namespace hydro::diagnose {

// The points with their 95 % intervals, and both models' curves over them. `si`: in SI units.
page::Figure MeasuredFigure(const MeasuredCurve& curve, bool si);

// A picture of each curve; empty if no balance could be formed.
std::string MeasuredSection(const Diagnosis& diagnosis, bool si);

}  // namespace hydro::diagnose
