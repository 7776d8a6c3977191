#include "page/strokes.h"

#include <spdlog/fmt/fmt.h>

#include "page/svg.h"

namespace hydro::page {
namespace {

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

}  // namespace hydro::page
