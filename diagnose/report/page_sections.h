// The sections of report.html. Each is HTML, or "" when there is nothing to say. `diagnosis` is in the units
// that are shown. Its signals stay in the model's units, and `si` selects the units in which they are shown.
#pragma once

#include <string>

#include "diagnose/recording/diagnosis.h"
#include "page/html_page.h"

namespace hydro::diagnose {

std::string WhatWasFound(const Diagnosis& diagnosis, bool si);
// What the machine itself does: friction, leakage, load.
std::string MeasuredSection(const Diagnosis& diagnosis);
std::string HowSure(const Diagnosis& diagnosis);
// The explanations with their weights. The first `set_90` are marked.
std::string WhatMayExplain(const Diagnosis& diagnosis);
std::string HowMuchOfTheGap(const Diagnosis& diagnosis);
std::string WhatRemains(const Diagnosis& diagnosis);
// For each closure: its curve with the band (for a surface, a cut through it), its values, and the gap before
// and after.
std::string ClosureSection(const Diagnosis& diagnosis);
// Values that belong to a run (friction of the day, payload, temperature): one row for each run.
std::string PerRunSection(const Diagnosis& diagnosis);
std::string WhatToMeasureNext(const Diagnosis& diagnosis);

// The elements of sections: table cells, with two digits where they are short; pictures of curves, side by
// side; escaped text that keeps its line breaks.
using page::Cell;
using page::NumberCell;
using page::Table;
std::string ShortCell(double value);
std::string PercentCell(double part);
std::string IntervalCell(const Estimated& estimated);
std::string Curves(const std::vector<MeasuredCurve>& curves, const std::string& what);
std::string Lines(const std::string& text);

}  // namespace hydro::diagnose
