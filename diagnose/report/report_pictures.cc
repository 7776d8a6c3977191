#include "diagnose/report/report_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

std::string WithBlanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string Label(const std::string& name, const std::string& unit) {
  return WithBlanks(name) + (unit.empty() ? "" : " (" + unit + ")");
}

page::Figure CurveFigure(const MeasuredCurve& curve, const std::string& what) {
  struct Style {
    std::string points, found, name;
    int colour;
    page::Stroke stroke;
  };
  const bool missing = curve.element.empty(), term = curve.element.find('.') != std::string::npos;
  const Style style =
      missing ? Style{"", "", "missing in " + curve.balance, kAfter, page::Stroke::kLinePoints}
      : term
          ? Style{"lacking without it", "the effect as found", curve.balance, kBefore, page::Stroke::kPoints}
          : Style{"measured", kAfterLabel, curve.element, kRefit, page::Stroke::kPoints};
  page::Curve points = page::Line(style.points, curve.at, curve.measured, style.colour, style.stroke);
  page::Range x, y;
  x.Include(curve.at);
  y.Include(0.0);
  for (const std::vector<double>* one : {&curve.measured, &curve.model, &curve.found}) y.Include(*one);
  const double room = 0.5 * (y.high - y.low), low = y.low - room, high = y.high + room;
  for (size_t i = 0; i < curve.at.size(); ++i) {
    points.y_low.push_back(curve.measured[i] - 1.96 * curve.error[i]);
    points.y_high.push_back(curve.measured[i] + 1.96 * curve.error[i]);
    y.Include(std::max(points.y_low.back(), low));
    y.Include(std::min(points.y_high.back(), high));
  }
  x = x.WithMargin(), y = y.WithMargin();
  page::Panel panel;
  panel.x = {.label = Label(curve.against, curve.against_unit), .min = x.low, .max = x.high};
  panel.y = {.label = Label(what.empty() ? style.name : what, curve.unit), .min = y.low, .max = y.high};
  if (!curve.model.empty()) panel.curves.push_back(page::Line(kBeforeLabel, curve.at, curve.model, kBefore));
  if (!curve.found.empty() && curve.found != curve.model) {
    panel.curves.push_back(page::Line(style.found, curve.at, curve.found, kAfter));
    panel.curves.back().weight = page::Weight::kStrong;
  }
  panel.curves.push_back(std::move(points));
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 180};
}

page::Figure HorizonFigure(const Diagnosis& diagnosis) {
  struct Kind {
    const char* label;
    double BeforeAfter::*gap;
    int colour;
  };
  constexpr Kind kKinds[] = {{kBeforeLabel, &BeforeAfter::before, kBefore},
                             {"its own values refitted", &BeforeAfter::refit_only, kRefit},
                             {kAfterLabel, &BeforeAfter::after, kAfter}};
  page::Panel panel;
  panel.x = {.label = "predicted over (s)", .logarithmic = true};
  panel.y = {.label = "gap in noise units", .logarithmic = true, .min = 0.8, .max = 3};
  panel.rules = {{"noise floor", false, 1}};
  for (const Kind& kind : kKinds) {
    page::Curve held_out = page::Line(kind.label, {}, {}, kind.colour, page::Stroke::kLinePoints);
    page::Curve fitted = page::Line("", {}, {}, kind.colour, page::Stroke::kDashed);
    held_out.weight = page::Weight::kStrong;
    for (const HorizonGap& horizon : diagnosis.horizons) {
      for (auto [curve, gap] : {std::pair{&held_out, &horizon.held_out}, {&fitted, &horizon.fit}}) {
        const double value = gap->*kind.gap;
        const bool drawn = std::isfinite(value) && value > 0;
        curve->x.push_back(horizon.seconds);
        curve->y.push_back(drawn ? value : std::nan(""));
        if (!drawn) continue;
        panel.y.min = std::min(panel.y.min, 0.9 * value);
        panel.y.max = std::max(panel.y.max, 1.2 * value);
      }
    }
    panel.curves.push_back(std::move(held_out));
    panel.curves.push_back(std::move(fitted));
  }
  for (const HorizonGap& horizon : diagnosis.horizons)
    panel.x.ticks.push_back({horizon.seconds, ShortNumber(horizon.seconds, 2)});
  if (!diagnosis.horizons.empty()) {
    panel.x.min = 0.8 * diagnosis.horizons.front().seconds;
    panel.x.max = 1.25 * diagnosis.horizons.back().seconds;
  }
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 200};
}

}  // namespace hydro::diagnose
