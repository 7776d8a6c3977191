// What was found, in pictures: its term, a stretch where it shows, and what it takes of the gap.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "diagnose/data/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/picture_parts.h"
#include "diagnose/report/report_pictures.h"

namespace hydro::diagnose {

page::Figure HorizonFigure(const Diagnosis& diagnosis) {
  page::Panel panel;
  panel.x = {.label = "predicted over (s)", .logarithmic = true};
  panel.y = {.label = "gap in noise units", .logarithmic = true};
  panel.rules = {{"noise floor", false, 1}};
  const std::array<std::pair<const char*, double BeforeAfter::*>, 3> kinds = {
      {{kBeforeLabel, &BeforeAfter::before},
       {"its own values refitted", &BeforeAfter::refit_only},
       {kAfterLabel, &BeforeAfter::after}}};
  const std::array<int, 3> colours = {kBefore, kRefit, kAfter};
  double lowest = 0.8, highest = 3;
  for (size_t k = 0; k < kinds.size(); ++k) {
    page::Curve held_out = page::Line(kinds[k].first, {}, {}, colours[k], page::Stroke::kLinePoints);
    page::Curve fitted = page::Line("", {}, {}, colours[k], page::Stroke::kDashed);
    held_out.weight = page::Weight::kStrong;
    for (const HorizonGap& horizon : diagnosis.horizons) {
      panel.x.ticks.resize(diagnosis.horizons.size());
      for (auto [curve, gap] : {std::pair{&held_out, &horizon.held_out}, {&fitted, &horizon.fit}}) {
        const double value = gap->*kinds[k].second;
        curve->x.push_back(horizon.seconds);
        curve->y.push_back(value > 0 ? value : std::nan(""));
        if (!std::isfinite(value) || !(value > 0)) continue;
        lowest = std::min(lowest, 0.9 * value);
        highest = std::max(highest, 1.2 * value);
      }
    }
    panel.curves.push_back(std::move(held_out));
    panel.curves.push_back(std::move(fitted));
  }
  for (size_t h = 0; h < diagnosis.horizons.size(); ++h) {
    const double seconds = diagnosis.horizons[h].seconds;
    panel.x.ticks[h] = {seconds, ShortNumber(seconds, 2)};
  }
  if (!diagnosis.horizons.empty()) {
    panel.x.min = 0.8 * diagnosis.horizons.front().seconds;
    panel.x.max = 1.25 * diagnosis.horizons.back().seconds;
  }
  panel.y.min = lowest;
  panel.y.max = highest;
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 200};
}

page::Figure FoundTermFigure(const FoundTerm& term) {
  page::Figure figure = MissingTermFigure(term.missing);
  page::Panel& panel = figure.panels.front();
  panel.y.label = WithBlanks(term.missing.balance) + " (" + term.missing.unit + ")";
  page::Curve& lacking = panel.curves.front();
  lacking.label = "lacking without it";
  lacking.stroke = page::Stroke::kPoints;
  lacking.colour = kBefore;
  page::Range x, y;
  x.Include(term.at);
  x.Include(lacking.x);
  y.Include(term.value);
  y.Include(lacking.y_low);
  y.Include(lacking.y_high);
  y.Include(0.0);
  SetRange(panel.x, x.WithMargin());
  SetRange(panel.y, y.WithMargin());
  page::Curve own = page::Line("the effect as found", term.at, term.value, kAfter);
  own.weight = page::Weight::kStrong;
  panel.curves.insert(panel.curves.begin(), own);
  return figure;
}

page::Figure StretchFigure(const FoundStretch& stretch, const UnitSystem& units, bool si) {
  const ShownUnit unit = UnitOf(stretch.channel, units, si);
  const auto points = [&](const std::vector<double>& values) {
    return Points{stretch.time, Scaled(values, unit.factor)};
  };
  const Points measured = points(stretch.measured), without = points(stretch.without),
               with = points(stretch.with);
  page::Panel panel;
  panel.x = {.label = "time (s)", .min = stretch.time.front(), .max = stretch.time.back()};
  panel.y.label = LabelOf(stretch.channel, unit.unit);
  page::Range y;
  for (const Points* one : {&measured, &without, &with}) y.Include(one->y);
  SetRange(panel.y, y.WithMargin());
  panel.curves = {DrawnCurve("measured", measured, 0, page::Weight::kBackdrop),
                  DrawnCurve("without the effect", without, kBefore, page::Weight::kNormal),
                  DrawnCurve("with it", with, kAfter, page::Weight::kNormal)};
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 180};
}

}  // namespace hydro::diagnose
