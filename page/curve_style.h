// How curves look: one palette for the whole report.
#pragma once

#include <string>
#include <vector>

#include "page/plot.h"

namespace hydro::page {

struct CurveStyle {
  std::string colour;        // "#rrggbb"
  double width = 1.6;        // pixels; 0: no line
  std::vector<double> dash;  // pixels drawn, not drawn, ...; empty: solid
  int marker = 0;            // gnuplot's point type; 0: no markers
  double marker_radius = 0;  // pixels
};

// `place` is the curve's number in its panel.
CurveStyle StyleOf(const Curve& curve, int place);

}  // namespace hydro::page
