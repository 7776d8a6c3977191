#include "page/panel_geometry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "page/range.h"

namespace hydro::page {
namespace {

// The range of the values that an axis can show.
class Extent {
 public:
  explicit Extent(bool positive) : positive_(positive) {}
  void Add(double value) {
    if (!positive_ || value > 0) range_.Include(value);
  }
  const Range& range() const { return range_; }

 private:
  bool positive_;
  Range range_;
};

// The given bounds, or else the data's range with `margin` (a fraction of it) added on each side.
AxisRange Fit(const Axis& axis, const Range& data, double margin, const std::string& where) {
  AxisRange range{axis.min, axis.max, axis.logarithmic};
  const bool free_min = std::isnan(axis.min);
  const bool free_max = std::isnan(axis.max);
  if ((free_min || free_max) && data.empty()) throw std::invalid_argument(where + ": nothing to show");
  if (free_min) range.min = free_max ? data.low : std::min(data.low, axis.max);
  if (free_max) range.max = free_min ? data.high : std::max(data.high, axis.min);
  if (axis.logarithmic) {
    const double widen = range.max > range.min ? std::pow(range.max / range.min, margin) : 2;
    if (free_min) range.min /= widen;
    if (free_max) range.max *= widen;
  } else {
    double widen = margin * (range.max - range.min);
    if (!(range.max > range.min)) widen = range.max == 0 ? 1 : 0.1 * std::abs(range.max);
    // A quantity that starts at 0 keeps 0 as its edge.
    if (free_min && !(range.min == 0 && range.max > 0)) range.min -= widen;
    if (free_max && !(range.max == 0 && range.min < 0)) range.max += widen;
  }
  if (!(range.max > range.min) || (axis.logarithmic && range.min <= 0)) {
    throw std::invalid_argument(where + ": axis '" + axis.label + "' has no range");
  }
  return range;
}

// Gives one unit the same length on both axes.
void Equalise(PanelGeometry& panel) {
  const double x_unit = (panel.frame.right - panel.frame.left) / (panel.x.max - panel.x.min);
  const double y_unit = (panel.frame.bottom - panel.frame.top) / (panel.y.max - panel.y.min);
  const auto widen = [](AxisRange& range, double factor) {
    const double middle = (range.min + range.max) / 2;
    const double half = factor * (range.max - range.min) / 2;
    range.min = middle - half;
    range.max = middle + half;
  };
  if (x_unit > y_unit) {
    widen(panel.x, x_unit / y_unit);
  } else {
    widen(panel.y, y_unit / x_unit);
  }
}

}  // namespace

double AxisRange::Fraction(double value) const {
  return logarithmic ? std::log(value / min) / std::log(max / min) : (value - min) / (max - min);
}

PanelGeometry FitPanel(const Panel& panel, const Box& frame, const std::string& where) {
  if (panel.curves.empty()) throw std::invalid_argument(where + ": no curve");
  Extent x_data(panel.x.logarithmic);
  for (const Curve& curve : panel.curves) {
    const size_t points = curve.x.size();
    const auto fits = [&](const std::vector<double>& bound) {
      return bound.empty() || bound.size() == points;
    };
    if (curve.y.size() != points || !fits(curve.y_low) || !fits(curve.y_high) ||
        curve.y_low.empty() != curve.y_high.empty()) {
      throw std::invalid_argument(where + ": the vectors of curve '" + curve.label +
                                  "' are of unequal length");
    }
    for (size_t i = 0; i < points; ++i) {
      if (std::isfinite(curve.y[i])) x_data.Add(curve.x[i]);
    }
  }
  for (const Note& note : panel.notes) x_data.Add(note.x);
  for (const Rule& rule : panel.rules) {
    if (rule.vertical) x_data.Add(rule.value);
  }
  PanelGeometry geometry{frame, Fit(panel.x, x_data.range(), panel.equal_scales ? 0.05 : 0.0, where), {}};

  Extent y_data(panel.y.logarithmic);
  const AxisRange& shown = geometry.x;
  for (const Curve& curve : panel.curves) {
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (!shown.Holds(curve.x[i])) continue;
      y_data.Add(curve.y[i]);
      if (!curve.y_low.empty()) {
        y_data.Add(curve.y_low[i]);
        y_data.Add(curve.y_high[i]);
      }
    }
  }
  for (const Note& note : panel.notes) {
    if (shown.Holds(note.x)) y_data.Add(note.y);
  }
  for (const Rule& rule : panel.rules) {
    if (!rule.vertical) y_data.Add(rule.value);
  }
  geometry.y = Fit(panel.y, y_data.range(), 0.06, where);
  if (panel.equal_scales) Equalise(geometry);
  return geometry;
}

}  // namespace hydro::page
