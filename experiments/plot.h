// A figure as data: panels of curves over axes, and how it becomes an SVG picture.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace hydro {

inline constexpr double kAutomatic = std::numeric_limits<double>::quiet_NaN();

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

struct Axis {
  std::string label;  // quantity and unit: "pressure difference, psi"
  bool logarithmic = false;
  double min = kAutomatic;
  double max = kAutomatic;
};

// Text at a point of the panel (in axis units), with a dot there.
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
  bool equal_scales = false;  // one unit is as long on both axes (a plane of poles)
  double height = 1;          // beside the other panels'
};

// Panels stand one below the other.
struct Figure {
  std::string caption;  // what is shown and under which conditions; stands below the picture
  std::vector<Panel> panels;
  std::string drawing;  // instead of panels: a whole <svg> element, drawn otherwise
};

// The figure as a self-contained SVG document, its caption included; identical figures give identical bytes.
// `name` (letters and digits) keeps its ids apart from other pictures' in one page. Long curves are thinned
// to what the eye can see (extremes are kept). Runs gnuplot; throws std::runtime_error saying what to install
// when that is missing, or what it complained about.
std::string RenderSvg(const Figure& figure, const std::string& name);

}  // namespace hydro
