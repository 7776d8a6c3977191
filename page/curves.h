// How curves look, with one palette for all pictures, and which of their points are drawn.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "page/plot.h"

namespace hydro::page {

enum class Marker { kNone, kDisc, kSquare, kTriangle, kDiamond, kTriangleDown, kRing };

// The colours are in chart.css.
struct CurveStyle {
  std::string colour;        // a class of chart.css: "c0", ..., "pale"; plus "faint" for faint curves
  double width = 1.6;        // pixels; 0: no line
  std::vector<double> dash;  // pixels drawn, not drawn, ...; empty: solid
  Marker marker = Marker::kNone;
  double marker_radius = 0;  // pixels
};

// `place` is the curve's index in its panel.
CurveStyle StyleOf(const Curve& curve, int place);

// " stroke-width=... stroke-dasharray=..."
std::string LineAttributes(const CurveStyle& style);

// Markers at the points of `data`, each given as "M1 2".
std::string MarkerElement(const CurveStyle& style, const std::vector<std::string>& data);

// Reduces a long curve to what a picture can show: indices of the points to draw, in increasing order.
// `column` gives the pixel column of an x. Of consecutive points in one column, the first, lowest, highest
// and last are kept, so that the drawn line (or staircase) covers the same pixels. Of non-finite points that
// break the line, the first of each group is kept.
std::vector<size_t> ThinLine(std::span<const double> x, std::span<const double> y,
                             const std::function<double(double)>& column);

// The same for separate points: of the points in one pixel, only the first is kept, and non-finite points are
// dropped.
std::vector<size_t> ThinPoints(std::span<const double> x, std::span<const double> y,
                               const std::function<double(double)>& column,
                               const std::function<double(double)>& row);

}  // namespace hydro::page
