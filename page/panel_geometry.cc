#include "page/panel_geometry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "page/plot.h"

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

constexpr char kMinus[] = "−";

// The smallest 1, 2 or 5 times a power of ten that is at least `least`.
double RoundStep(double least) {
  const double decade = std::pow(10, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= least * (1 - 1e-9)) return digit * decade;
  }
  return 10 * decade;
}

std::vector<Tick> Multiples(const AxisRange& range, double step) {
  std::vector<Tick> ticks;
  const double last = std::floor(range.max / step + 1e-9);
  for (double k = std::ceil(range.min / step - 1e-9); k <= last; k += 1) {
    ticks.push_back({k * step, TickNumber(k * step)});
  }
  return ticks;
}

std::vector<Tick> LinearTicks(const AxisRange& range, double pixels, double label_pixels) {
  const double most = std::max(2.0, pixels / label_pixels);
  const double step = RoundStep((range.max - range.min) / most);
  if (!(step > 0) || !std::isfinite(step)) return {};
  const std::vector<Tick> ticks = Multiples(range, step);
  // One number alone shows no scale. The next smaller round step gives at most five numbers, for which a
  // short axis just has room.
  return ticks.size() > 1 ? ticks : Multiples(range, RoundStep(0.4 * step));
}

std::vector<Tick> LogarithmicTicks(const AxisRange& range, double pixels, double label_pixels) {
  const double decade_pixels = pixels / std::log10(range.max / range.min);
  // The digits that get a number: as many as there is room for. From 5 to 10 is 0.3 of a decade, and from 9
  // to 10 is 0.05.
  const auto numbered = [&](int digit, int power) {
    if (digit == 1) {
      const int every = std::max(1, static_cast<int>(std::ceil(label_pixels / decade_pixels)));
      return power % every == 0;
    }
    if (0.046 * decade_pixels > label_pixels) return true;
    return 0.29 * decade_pixels > label_pixels && (digit == 2 || digit == 5);
  };
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.min)));
  const int last = static_cast<int>(std::ceil(std::log10(range.max)));
  const bool fine = decade_pixels > 25;
  for (int power = first; power <= last; ++power) {
    for (int digit = 1; digit <= (fine ? 9 : 1); ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (value < range.min * (1 - 1e-9) || value > range.max * (1 + 1e-9)) continue;
      ticks.push_back({value, numbered(digit, power) ? TickNumber(value) : ""});
    }
  }
  return ticks;
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

std::vector<Tick> Ticks(const AxisRange& range, double pixels, double label_pixels) {
  if (!range.logarithmic) return LinearTicks(range, pixels, label_pixels);
  std::vector<Tick> ticks = LogarithmicTicks(range, pixels, label_pixels);
  // For an axis over less than a decade.
  const auto has_number = [](const Tick& tick) { return !tick.text.empty(); };
  if (std::count_if(ticks.begin(), ticks.end(), has_number) < 2) {
    AxisRange linear = range;
    linear.logarithmic = false;
    ticks = LinearTicks(linear, pixels, label_pixels);
  }
  return ticks;
}

std::string TickNumber(double value) {
  char text[40];
  // Writes the number as printf("%.6g") does in the C locale. In other locales, printf would write decimal
  // commas.
  std::string number(
      text, std::to_chars(text, text + sizeof text, std::abs(value), std::chars_format::general, 6).ptr);
  if (const size_t at = number.find('e'); at != std::string::npos) {
    const int power = std::atoi(number.c_str() + at + 1);
    const std::string factor = number.substr(0, at);
    number = (factor == "1" ? "" : factor + "×") + "10^{" + (power < 0 ? kMinus : "") +
             std::to_string(std::abs(power)) + "}";
  }
  return (value < 0 && number != "0" ? kMinus : "") + number;
}

}  // namespace hydro::page
