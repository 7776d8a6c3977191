// Lines and markers in a curve's style, as SVG.
#pragma once

#include <string>
#include <vector>

#include "page/curve_style.h"

namespace hydro::page {

// " stroke-width=... stroke-dasharray=..."
std::string LineAttributes(const CurveStyle& style);

// Markers at the points of `data`, each given as "M1 2".
std::string MarkerElement(const CurveStyle& style, const std::vector<std::string>& data);

}  // namespace hydro::page
