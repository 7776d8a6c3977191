#include "page/curve_style.h"

#include <array>

namespace hydro::page {
namespace {

struct Ink {
  std::vector<double> dash;
  Marker marker;
};

// One for each of chart.css's colours c0 to c5, whose hues stay distinct for colour-blind readers (after
// Okabe and Ito). Neighbours also differ in lightness, and colours that print as a similar grey differ in
// their dashes.
const std::array<Ink, 6>& Inks() {
  static const std::array<Ink, 6> inks = {{{{}, Marker::kDisc},
                                           {{}, Marker::kSquare},
                                           {{11, 3}, Marker::kTriangle},
                                           {{9, 3, 2, 3}, Marker::kDiamond},
                                           {{}, Marker::kTriangleDown},
                                           {{14, 3, 2, 3, 2, 3}, Marker::kRing}}};
  return inks;
}

constexpr size_t kFewPoints = 300;  // beyond this, separate points get small markers

}  // namespace

CurveStyle StyleOf(const Curve& curve, int place) {
  const size_t number = static_cast<size_t>(curve.colour >= 0 ? curve.colour : place) % Inks().size();
  const Ink& ink = Inks()[number];
  CurveStyle style{"c" + std::to_string(number), 1.6, ink.dash, Marker::kNone, 0};
  switch (curve.stroke) {
    case Stroke::kLine:
      break;
    case Stroke::kSteps:  // dashes would be lost in the corners
    case Stroke::kBars:
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
  if (style.marker != Marker::kNone) style.marker_radius = curve.x.size() <= kFewPoints ? 3.2 : 1.4;
  switch (curve.weight) {
    case Weight::kNormal:
      break;
    case Weight::kFaint:
      style.colour += " faint";
      style.width *= 0.5;
      style.marker_radius = style.marker == Marker::kNone ? 0 : 1.1;
      style.dash.clear();
      break;
    case Weight::kStrong:
      style.width *= 1.4;
      style.marker_radius *= 1.6;
      break;
    case Weight::kBackdrop:
      style.colour = "pale";
      style.width *= 2;
      style.dash.clear();
      break;
  }
  return style;
}

}  // namespace hydro::page
