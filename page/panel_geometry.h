// Maps a panel's values to positions in the picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "page/label_placement.h"
#include "page/plot.h"

namespace hydro::page {

struct AxisRange {
  double min = 0;
  double max = 1;
  bool logarithmic = false;

  bool Holds(double value) const { return value >= min && value <= max; }
  // 0 at min and 1 at max; not finite for a value that the axis cannot show.
  double Fraction(double value) const;
};

struct PanelGeometry {
  Box frame = {};  // in pixels of the picture
  AxisRange x = {};
  AxisRange y = {};

  // Clamped far outside the frame, because SVG readers fail on huge coordinates.
  double Column(double value) const {
    return frame.left + Bounded(x.Fraction(value)) * (frame.right - frame.left);
  }
  double Row(double value) const {
    return frame.bottom - Bounded(y.Fraction(value)) * (frame.bottom - frame.top);
  }
  bool Holds(double x_value, double y_value) const { return x.Holds(x_value) && y.Holds(y_value); }

 private:
  static double Bounded(double fraction) {
    return std::isfinite(fraction) ? std::clamp(fraction, -10.0, 11.0)
                                   : std::numeric_limits<double>::quiet_NaN();
  }
};

// The ranges of a panel: the given ones, or else ranges wide enough for all curves, notes and rules. `where`
// is for messages. Throws std::invalid_argument as FigureElement() does.
PanelGeometry FitPanel(const Panel& panel, const Box& frame, const std::string& where);

}  // namespace hydro::page
