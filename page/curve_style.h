// How curves look: one palette for all pictures. The colours are in chart.css.
#pragma once

#include <string>
#include <vector>

#include "page/plot.h"

namespace hydro::page {

enum class Marker { kNone, kDisc, kSquare, kTriangle, kDiamond, kTriangleDown, kRing };

struct CurveStyle {
  std::string colour;        // a class of chart.css: "c0", ..., "pale"; plus "faint" for faint curves
  double width = 1.6;        // pixels; 0: no line
  std::vector<double> dash;  // pixels drawn, not drawn, ...; empty: solid
  Marker marker = Marker::kNone;
  double marker_radius = 0;  // pixels
};

// `place` is the curve's index in its panel.
CurveStyle StyleOf(const Curve& curve, int place);

}  // namespace hydro::page
