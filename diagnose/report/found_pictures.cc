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
namespace {

// The length of a stretch, in points of a run's curves.
constexpr size_t kStretch = 60;

// A channel that the effect names; else its pressures where it is of pressure sensors.
bool MayChange(const FoundEffect& effect, model::Channel channel) {
  for (const std::string& name : effect.names) {
    if (name.starts_with("signal = ")) return name == "signal = " + ChannelName(channel);
  }
  const bool pressure = channel == model::Channel::kP1 || channel == model::Channel::kP2;
  return pressure || !effect.id.starts_with("sensor.pressure");
}

}  // namespace

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
  return {.caption = "", .panels = {panel}, .width = 560, .panel_height = 200};
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

std::optional<Stretch> WhereItShows(const Diagnosis& diagnosis, const FoundEffect& effect) {
  std::optional<Stretch> best;
  double most = 0;
  for (const RunCurves& run : diagnosis.curves) {
    for (const RunCurves::Curve& curve : run.curves) {
      const double noise = NoiseOf(diagnosis, curve.channel);
      const size_t size = run.time.size();
      const bool whole = curve.before.size() == size && curve.after.size() == size && size >= 2;
      if (!whole || !(noise > 0) || !MayChange(effect, curve.channel)) continue;
      const size_t length = std::min(kStretch, size);
      for (size_t first = 0; first + length <= size; first += std::max<size_t>(1, length / 4)) {
        double sum = 0;
        for (size_t i = first; i < first + length; ++i) {
          const double apart = std::abs(curve.after[i] - curve.before[i]) / noise;
          sum += std::isfinite(apart) ? apart : 0;
        }
        if (!(sum > most)) continue;
        most = sum;
        best = Stretch{&run, &curve, first, first + length};
      }
    }
  }
  return best;
}

page::Figure StretchFigure(const Diagnosis& diagnosis, const Stretch& stretch, bool si) {
  const ShownUnit unit = UnitOf(stretch.curve->channel, diagnosis.model.units, si);
  const auto part = [&](const std::vector<double>& values) {
    const auto begin = values.begin();
    return std::vector<double>(begin + static_cast<std::ptrdiff_t>(stretch.first),
                               begin + static_cast<std::ptrdiff_t>(stretch.end));
  };
  const std::vector<double> time = part(stretch.curves->time);
  const auto points = [&](const std::vector<double>& values) {
    return Points{time, Scaled(part(values), unit.factor)};
  };
  const Points measured = points(stretch.curve->measured), before = points(stretch.curve->before),
               after = points(stretch.curve->after);
  page::Panel panel;
  panel.x = {.label = "time (s)", .min = time.front(), .max = time.back()};
  panel.y.label = LabelOf(stretch.curve->channel, unit.unit);
  page::Range y;
  for (const Points* one : {&measured, &before, &after}) y.Include(one->y);
  SetRange(panel.y, y.WithMargin());
  panel.curves = {DrawnCurve("measured", measured, 0, page::Weight::kBackdrop),
                  DrawnCurve(kBeforeLabel, before, kBefore, page::Weight::kNormal),
                  DrawnCurve(kAfterLabel, after, kAfter, page::Weight::kNormal)};
  return {.caption = "", .panels = {panel}, .width = 560, .panel_height = 180};
}

}  // namespace hydro::diagnose
