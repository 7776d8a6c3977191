#include "diagnose/report/measured_section.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/units.h"
#include "diagnose/report/picture_parts.h"
#include "page/figure_svg.h"

namespace hydro::diagnose {
namespace {

// In the unit of the page.
MeasuredCurve Shown(MeasuredCurve curve, bool si) {
  if (!si) return curve;
  const auto convert = [](std::string* unit, const std::vector<std::vector<double>*>& all) {
    double largest = 0;
    for (const double value : *all.front()) largest = std::max(largest, std::abs(value));
    const std::optional<SiUnit> to = FindSiUnit(*unit, largest);
    if (!to.has_value()) return;
    for (std::vector<double>* values : all) {
      for (double& value : *values) value *= to->factor;
    }
    *unit = to->to;
  };
  convert(&curve.unit, {&curve.measured, &curve.error, &curve.model, &curve.found});
  convert(&curve.against_unit, {&curve.at});
  return curve;
}

}  // namespace

page::Figure MeasuredFigure(const MeasuredCurve& given, bool si) {
  const MeasuredCurve curve = Shown(given, si);
  page::Curve measured = page::Line("measured", curve.at, curve.measured, 0, page::Stroke::kPoints);
  for (size_t i = 0; i < curve.at.size(); ++i) {
    measured.y_low.push_back(curve.measured[i] - 1.96 * curve.error[i]);
    measured.y_high.push_back(curve.measured[i] + 1.96 * curve.error[i]);
  }
  measured.colour = kRefit;
  page::Range x, y;
  x.Include(curve.at);
  y.Include(0.0);
  y.Include(measured.y_low);
  y.Include(measured.y_high);
  y.Include(curve.model);
  y.Include(curve.found);
  page::Panel panel;
  panel.x.label = WithBlanks(curve.against) + " (" + curve.against_unit + ")";
  panel.y.label = WithBlanks(curve.element) + " (" + curve.unit + ")";
  SetRange(panel.x, x.WithMargin());
  SetRange(panel.y, y.WithMargin());
  panel.curves = {page::Line(kBeforeLabel, curve.at, curve.model, kBefore)};
  if (curve.found != curve.model) {
    panel.curves.push_back(page::Line(kAfterLabel, curve.at, curve.found, kAfter));
    panel.curves.back().weight = page::Weight::kStrong;
  }
  panel.curves.push_back(std::move(measured));
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 180};
}

std::string MeasuredSection(const Diagnosis& diagnosis, bool si) {
  std::string figures;
  for (const MeasuredCurve& curve : diagnosis.measured) {
    figures += page::HtmlFigure(MeasuredFigure(curve, si),
                                WithBlanks(curve.element) + " as measured and as modelled");
  }
  if (figures.empty()) return "";
  return "<p>What the equations need at the measured motion, without any simulation: means of stretches of "
         "16 ms with 95 % "
         "intervals, and what the models have at the same instants.</p>\n<div class=\"plots\">\n" +
         figures + "</div>\n";
}

}  // namespace hydro::diagnose
