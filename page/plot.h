// A figure as data: panels of curves over axes. page/figure_svg.h draws it.
//
// All texts are plain, with Greek and other letters in UTF-8. Two marks have a meaning:
//   _x  _ms  _{any text}   a subscript: the letters and digits that follow, or what the braces hold
//   ^2  ^-1  ^{any text}   a superscript
// They apply after a letter, digit, prime or closing bracket: "p_2 - p_1, psi", "s^{-1}", "V_ms". A subscript
// without braces also needs a symbol of one or two letters before it, so that names such as p1_psi and
// static_excess stay unchanged.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace hydro::page {

inline constexpr double kAutomatic = std::numeric_limits<double>::quiet_NaN();

// kSteps holds each value until the next x. kBars does the same, and also fills the area down to the panel's
// edge.
enum class Stroke { kLine, kDashed, kDotted, kSteps, kBars, kPoints, kLinePoints };

// How much a curve stands out. kBackdrop is wide and pale, a background for comparison.
enum class Weight { kNormal, kFaint, kStrong, kBackdrop };

struct Curve {
  std::string label = {};      // in the key; empty: none
  std::vector<double> x = {};  // of equal length; a NaN in y breaks the line
  std::vector<double> y = {};
  Stroke stroke = Stroke::kLine;
  // 0, 1, 2 ... choose from the palette, so that curves of one kind look alike across panels; -1: the curve's
  // index in its panel.
  int colour = -1;
  // The bounds of each point, drawn as a vertical bar; empty: none.
  std::vector<double> y_low = {};
  std::vector<double> y_high = {};
  Weight weight = Weight::kNormal;
};

// y over x without bounds.
inline Curve Line(const std::string& label, const std::vector<double>& x, const std::vector<double>& y,
                  int colour, Stroke stroke = Stroke::kLine) {
  return {.label = label, .x = x, .y = y, .stroke = stroke, .colour = colour};
}

// A value on an axis and its text.
struct Tick {
  double value = 0;
  std::string text;
};

struct Axis {
  std::string label = {};    // quantity and unit: "pressure difference, psi"
  bool logarithmic = false;  // values of 0 and below are not drawn
  double min = kAutomatic;
  double max = kAutomatic;
  std::vector<Tick> ticks = {};  // replace round numbers, e.g. names of what is compared
  bool numbers = true;           // false: no numbers at the ticks; the panel below shows them
};

// Text at a point of the panel (in axis units). A dot marks the point, and the text is placed on the side of
// it where it hides least. Notes, rules and bands outside a given range are not drawn.
struct Note {
  std::string text;
  double x = 0;
  double y = 0;
};

// A straight line across the panel at an x or y value, e.g. a limit or a resonance.
struct Rule {
  std::string label;
  bool vertical = false;
  double value = 0;
};

// A shaded stretch of the x axis (vertical) or of the y axis, over the whole panel: a time window, a noise
// floor.
struct Band {
  std::string label;  // in the key; empty: none
  bool vertical = false;
  double from = 0;
  double to = 0;
};

struct Panel {
  std::string title = {};
  Axis x = {};
  Axis y = {};
  std::vector<Curve> curves = {};
  std::vector<Note> notes = {};
  std::vector<Rule> rules = {};
  // One unit is equally long on both axes (for a plane of poles): one of the two ranges is widened, even if
  // it was given.
  bool equal_scales = false;
  double height = 1;  // relative to the other panels
  double width = 1;   // relative to the panels in its row
  std::vector<Band> bands = {};
};

// Panels stand below each other, or side by side in rows. A panel's key extends over panels beside it that
// have none.
struct Figure {
  std::string caption = {};  // what is shown, under which conditions; stands below the picture
  std::vector<Panel> panels = {};
  // A whole <svg> element that replaces the panels. Its first tag has a viewBox="0 0 WIDTH HEIGHT". It must
  // keep its ids unique.
  std::string drawing = {};
  size_t columns = 1;
  double width = 860;       // pixels
  double panel_height = 0;  // height of a panel's frame, pixels; 0: chosen by the number of panels
};

// A range that grows to hold values.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool empty() const { return !(low <= high); }
  // Ignores values that are not finite.
  void Include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void Include(const std::vector<double>& values) {
    for (const double value : values) Include(value);
  }
  // The range widened by an eighteenth on each side, and never empty.
  Range WithMargin() const {
    if (empty()) return {-1, 1};
    const double margin = high > low ? (high - low) / 18 : std::max(1e-6, std::abs(low) / 10);
    return {low - margin, high + margin};
  }
};

}  // namespace hydro::page
