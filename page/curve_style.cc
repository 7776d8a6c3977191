#include "page/curve_style.h"

#include <array>

namespace hydro::page {
namespace {

struct Ink {
  const char* colour;
  std::vector<double> dash;
  int marker;
};

// Hues that stay apart for the colour-blind (after Okabe and Ito). Neighbours differ in lightness too; those
// that print in a like grey differ in dashes.
const std::array<Ink, 6>& Inks() {
  static const std::array<Ink, 6> inks = {{{"#0b3c6f", {}, 7},
                                           {"#dd6b00", {}, 5},
                                           {"#008a68", {11, 3}, 9},
                                           {"#b05a96", {9, 3, 2, 3}, 13},
                                           {"#4aa3df", {}, 11},
                                           {"#6b6b6b", {14, 3, 2, 3, 2, 3}, 6}}};
  return inks;
}

constexpr size_t kFewPoints = 300;  // beyond these, separate points get small markers

}  // namespace

CurveStyle StyleOf(const Curve& curve, int place) {
  const Ink& ink = Inks()[static_cast<size_t>(curve.colour >= 0 ? curve.colour : place) % Inks().size()];
  CurveStyle style{ink.colour, 1.6, ink.dash, 0, 0};
  switch (curve.stroke) {
    case Stroke::kLine:
      break;
    case Stroke::kSteps:  // dashes would be lost in its corners
      style.dash.clear();
      break;
    case Stroke::kDashed:
      style.dash = {6, 3.5};
      break;
    case Stroke::kDotted:
      style.dash = {1.2, 3.2};
      style.width = 1.9;
      break;
    case Stroke::kPoints:
      style.width = 0;
      style.marker = ink.marker;
      break;
    case Stroke::kLinePoints:
      style.marker = ink.marker;
      break;
  }
  if (style.marker != 0) style.marker_radius = curve.x.size() <= kFewPoints ? 3.0 : 1.4;
  return style;
}

}  // namespace hydro::page
