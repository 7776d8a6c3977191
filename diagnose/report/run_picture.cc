// Signals of a run over time, and what the models leave of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/picture_parts.h"
#include "diagnose/report/report_pictures.h"

namespace hydro::diagnose {
namespace {

// Limits a simulation that runs away to the size of the measured range beyond that range.
page::Range RangeOf(const Points& measured, const Points& before, const Points& after) {
  page::Range range;
  range.Include(measured.y);
  const double size = range.high - range.low;
  const page::Range most{range.low - size, range.high + size};
  for (const Points* points : {&before, &after}) {
    for (const double y : points->y) {
      if (std::isfinite(y)) range.Include(most.empty() ? y : std::clamp(y, most.low, most.high));
    }
  }
  return range.WithMargin();
}

// Means over stretches of time, which average the noise away.
Points RunningMean(const Points& series) {
  constexpr size_t kStretches = 100;
  Points means;
  const size_t size = series.x.size();
  for (size_t k = 0; k < std::min(kStretches, size); ++k) {
    const size_t from = k * size / std::min(kStretches, size);
    const size_t to = (k + 1) * size / std::min(kStretches, size);
    double sum = 0;
    size_t count = 0;
    for (size_t i = from; i < to; ++i) {
      if (!std::isfinite(series.y[i])) continue;
      sum += series.y[i];
      ++count;
    }
    means.x.push_back((series.x[from] + series.x[to - 1]) / 2);
    means.y.push_back(count == 0 ? std::nan("") : sum / static_cast<double>(count));
  }
  return means;
}

// One signal of a run: measured and simulated, then the residuals. The first row of a picture has the keys,
// the last one the numbers of the time axis.
std::array<page::Panel, 2> SignalPanels(const Diagnosis& diagnosis, const RunCurves& run,
                                        const RunCurves::Curve& curve, const page::Range& time, bool si,
                                        bool first, bool last) {
  constexpr double kSignalShare = 0.58;
  const ShownUnit unit = UnitOf(curve.channel, diagnosis.model.units, si);
  const double noise = unit.factor * NoiseOf(diagnosis, curve.channel);
  const auto over_time = [&](const std::vector<double>& y) {
    return y.size() == run.time.size() ? Points{run.time, y} : Points{};
  };
  const auto label = [first](const char* text) { return first ? text : ""; };
  using page::Weight;

  page::Panel signals;
  signals.width = kSignalShare;
  signals.x = {.label = last ? "time (s)" : "", .min = time.low, .max = time.high, .numbers = last};
  signals.y.label = LabelOf(curve.channel, unit.unit);
  if (!diagnosis.location.empty()) {
    for (const Window& window : diagnosis.location.front().windows) {
      if (window.run != run.run) continue;
      const bool labelled = first && signals.bands.empty();
      signals.bands.push_back({labelled ? "largest disagreement" : "", true, window.from, window.to});
    }
  }
  page::Panel residuals = signals;
  for (page::Band& band : residuals.bands) band.label.clear();
  const Points measured = over_time(Scaled(curve.measured, unit.factor));
  const Points before = over_time(Scaled(curve.before, unit.factor));
  const Points after = over_time(Scaled(curve.after, unit.factor));
  signals.curves = {DrawnCurve(label("measured"), measured, 0, Weight::kBackdrop),
                    DrawnCurve(label(kBeforeLabel), before, kBefore, Weight::kNormal),
                    DrawnCurve(label(kAfterLabel), after, kAfter, Weight::kNormal)};
  SetRange(signals.y, RangeOf(measured, before, after));

  residuals.width = 1 - kSignalShare;
  residuals.y.label = "measured - model";
  if (noise > 0) residuals.bands.push_back({label(kNoiseLabel), false, -2 * noise, 2 * noise});
  const Points left_before = over_time(ScaledResiduals(curve.measured, curve.before, unit.factor));
  const Points left_after = over_time(ScaledResiduals(curve.measured, curve.after, unit.factor));
  residuals.curves = {DrawnCurve("", left_before, kBefore, Weight::kFaint),
                      DrawnCurve("", left_after, kAfter, Weight::kFaint),
                      DrawnCurve("", RunningMean(left_before), kBefore, Weight::kStrong),
                      DrawnCurve(label("means"), RunningMean(left_after), kAfter, Weight::kStrong)};
  SetRange(residuals.y, ResidualRange(left_before, left_after, SizeOf(measured.y), noise));
  return {signals, residuals};
}

}  // namespace

std::optional<page::Figure> RunFigure(const Diagnosis& diagnosis, const RunCurves& run, bool si) {
  page::Range time;
  time.Include(run.time);
  if (!(time.low < time.high) || run.curves.empty()) return std::nullopt;
  page::Figure figure{
      .caption = "", .panels = {}, .columns = 2, .width = kPageWidth, .panel_height = kRowHeight};
  for (size_t i = 0; i < run.curves.size(); ++i) {
    for (page::Panel& panel :
         SignalPanels(diagnosis, run, run.curves[i], time, si, i == 0, i + 1 == run.curves.size())) {
      figure.panels.push_back(std::move(panel));
    }
  }
  return figure;
}

}  // namespace hydro::diagnose
