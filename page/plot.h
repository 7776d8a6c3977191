// A figure as data: panels of curves over axes, and how it becomes an SVG picture.
//
// All texts of a figure are plain: Greek and other letters as UTF-8, nothing is interpreted but
//   _x  _ms  _{any text}   a subscript: the letters and digits that follow, or what the braces hold
//   ^2  ^-1  ^{any text}   the same as a superscript
// where a letter, digit, prime or closing bracket stands before it: "p_2 - p_1, psi", "s^{-1}", "V_ms". A
// subscript without braces also needs a symbol of one or two letters there, so that names such as p1_psi and
// static_excess stay as they are.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace hydro::page {

inline constexpr double kAutomatic = std::numeric_limits<double>::quiet_NaN();

// kSteps holds each value until the next x.
enum class Stroke { kLine, kDashed, kDotted, kSteps, kPoints, kLinePoints };

struct Curve {
  std::string label;      // in the key; empty: not there
  std::vector<double> x;  // of equal length; a NaN in y breaks the line
  std::vector<double> y;
  Stroke stroke = Stroke::kLine;
  // 0, 1, 2 ... choose from the report's palette, so that curves of one kind look alike across panels; -1:
  // the curve's place in its panel.
  int colour = -1;
  // Empty, or bounds of each point, drawn as a vertical bar.
  std::vector<double> y_low;
  std::vector<double> y_high;
};

// y over x without bounds.
Curve Line(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, int colour,
           Stroke stroke = Stroke::kLine);

struct Axis {
  std::string label;         // quantity and unit: "pressure difference, psi"
  bool logarithmic = false;  // values that are not positive are not drawn
  double min = kAutomatic;
  double max = kAutomatic;
};

// Text at a point of the panel (in axis units), with a dot there. It is put on the side of the dot where it
// hides least. Notes and rules outside a range that was given are not drawn.
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

struct Panel {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Curve> curves;
  std::vector<Note> notes;
  std::vector<Rule> rules;
  // One unit is as long on both axes (a plane of poles): one of the two ranges, given ones too, is widened.
  bool equal_scales = false;
  double height = 1;  // beside the other panels'
};

// Panels stand one below the other.
struct Figure {
  std::string caption;  // what is shown and under which conditions; stands below the picture
  std::vector<Panel> panels;
  // Instead of panels: a whole <svg> element, drawn otherwise. Its first tag has a viewBox="0 0 WIDTH
  // HEIGHT"; its ids are its own to keep apart.
  std::string drawing;
};

// The figure as a self-contained SVG document, its caption included; identical figures give identical bytes.
// `name` (letters, digits, hyphens) keeps its ids apart from other pictures' in one page. Long curves are
// thinned to what the eye can see (extremes are kept). Runs gnuplot; throws std::runtime_error saying what to
// install when that is missing, or what it complained about; std::invalid_argument naming the panel for a
// figure that cannot be drawn (vectors of unequal length, no panel, nothing to show, an empty range).
std::string RenderSvg(const Figure& figure, const std::string& name);

}  // namespace hydro::page
