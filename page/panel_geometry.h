// Maps a panel's values to positions in the picture; the ticks of its axes and their numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "page/plot.h"
#include "page/svg.h"

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

// Ticks within the range, in rising order. They are round numbers with room between their labels on an axis
// that is `pixels` long, where each label takes `label_pixels` along it. A logarithmic axis also has ticks
// without a number (empty text) in between.
std::vector<Tick> Ticks(const AxisRange& range, double pixels, double label_pixels);

// "0.25", "−3", "2×10^{-5}": written in the convention of page/plot.h.
std::string TickNumber(double value);

}  // namespace hydro::page
