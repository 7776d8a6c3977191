#include "page/curves.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "page/svg.h"

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

std::string MarkerShape(Marker marker, double r) {
  switch (marker) {
    case Marker::kNone:
      return "";
    case Marker::kDisc:
    case Marker::kRing:
      return fmt::format("m{0:.4g} 0a{1:.4g} {1:.4g} 0 1 0 {2:.4g} 0a{1:.4g} {1:.4g} 0 1 0 -{2:.4g} 0z", -r,
                         r, 2 * r);
    case Marker::kSquare:
      return fmt::format("m{0:.4g} {0:.4g}h{1:.4g}v{1:.4g}h-{1:.4g}z", -0.88 * r, 1.76 * r);
    case Marker::kTriangle:
      return fmt::format("m0 {:.4g}l{:.4g} {:.4g}h{:.4g}z", -1.2 * r, 1.1 * r, 1.9 * r, -2.2 * r);
    case Marker::kDiamond:
      return fmt::format("m0 {0:.4g}l{1:.4g} {1:.4g}l-{1:.4g} {1:.4g}l-{1:.4g} -{1:.4g}z", -1.25 * r,
                         1.25 * r);
    case Marker::kTriangleDown:
      return fmt::format("m0 {:.4g}l{:.4g} {:.4g}h{:.4g}z", 1.2 * r, -1.1 * r, -1.9 * r, 2.2 * r);
  }
  return "";
}

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

std::string LineAttributes(const CurveStyle& style) {
  std::string text = fmt::format(" stroke-width=\"{:g}\"", style.width);
  for (size_t i = 0; i < style.dash.size(); ++i) {
    text += fmt::format("{}{:g}", i == 0 ? " stroke-dasharray=\"" : " ", style.dash[i]);
  }
  return text + (style.dash.empty() ? "" : "\"");
}

std::string MarkerElement(const CurveStyle& style, const std::vector<std::string>& data) {
  if (data.empty()) return "";
  constexpr double kSmall = 2;  // too small to tell a shape from a disc
  const bool small = style.marker_radius < kSmall;
  std::string path;
  const std::string shape = small ? "h0" : MarkerShape(style.marker, style.marker_radius);
  for (const std::string& point : data) path += point + shape;
  if (small)
    return SvgPath("dots " + style.colour, path,
                   fmt::format(" stroke-width=\"{:g}\"", 2 * style.marker_radius));
  return SvgPath((style.marker == Marker::kRing ? "rings " : "marks ") + style.colour, path);
}

std::vector<size_t> ThinLine(std::span<const double> x, std::span<const double> y,
                             const std::function<double(double)>& column) {
  std::vector<size_t> kept;
  // A logarithmic axis has no column for values of 0 or below.
  const auto finite = [&](size_t i) { return std::isfinite(column(x[i])) && std::isfinite(y[i]); };
  for (size_t begin = 0; begin < x.size();) {
    if (!finite(begin)) {
      kept.push_back(begin);
      while (begin < x.size() && !finite(begin)) ++begin;
      continue;
    }
    const double here = std::floor(column(x[begin]));
    size_t end = begin;
    size_t lowest = begin;
    size_t highest = begin;
    for (; end < x.size() && finite(end) && std::floor(column(x[end])) == here; ++end) {
      if (y[end] < y[lowest]) lowest = end;
      if (y[end] > y[highest]) highest = end;
    }
    std::array<size_t, 4> some = {begin, lowest, highest, end - 1};
    std::sort(some.begin(), some.end());
    kept.insert(kept.end(), some.begin(), std::unique(some.begin(), some.end()));
    begin = end;
  }
  return kept;
}

std::vector<size_t> ThinPoints(std::span<const double> x, std::span<const double> y,
                               const std::function<double(double)>& column,
                               const std::function<double(double)>& row) {
  std::vector<size_t> kept;
  std::set<std::pair<double, double>> taken;
  for (size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(column(x[i])) || !std::isfinite(row(y[i]))) continue;
    if (taken.emplace(std::floor(column(x[i])), std::floor(row(y[i]))).second) kept.push_back(i);
  }
  return kept;
}

}  // namespace hydro::page
