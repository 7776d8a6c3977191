// Signals over time, and what the models leave of them.
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnose/recording/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/report_pictures.h"

namespace hydro::diagnose {
namespace {

using page::Weight;

struct Points {
  std::vector<double> x, y;
};

page::Curve Drawn(const std::string& label, const Points& points, int colour, Weight weight) {
  page::Curve curve = page::Line(label, points.x, points.y, colour);
  curve.weight = weight;
  return curve;
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

// A measured signal over time and its predictions by two models, in the order of the colours. Models that
// diverge may extend beyond the measured range by its height at most.
page::Panel SignalPanel(const std::string& label, const Points& measured, const Points& before,
                        const Points& after, const std::array<const char*, 3>& keys) {
  page::Panel panel;
  panel.y.label = label;
  panel.curves = {Drawn(keys[0], measured, 0, Weight::kBackdrop),
                  Drawn(keys[1], before, kBefore, Weight::kNormal),
                  Drawn(keys[2], after, kAfter, Weight::kNormal)};
  page::Range range;
  range.Include(measured.y);
  const double size = range.high - range.low;
  const page::Range most{range.low - size, range.high + size};
  for (const Points* points : {&before, &after}) {
    for (const double y : points->y) {
      if (std::isfinite(y)) range.Include(most.empty() ? y : std::clamp(y, most.low, most.high));
    }
  }
  panel.y.min = range.WithMargin().low;
  panel.y.max = range.WithMargin().high;
  return panel;
}

Points Left(const Points& measured, const Points& simulated) {
  Points left;
  if (simulated.y.size() != measured.y.size()) return left;
  left.x = measured.x;
  for (size_t i = 0; i < measured.y.size(); ++i) left.y.push_back(measured.y[i] - simulated.y[i]);
  return left;
}

// Means over stretches of time, which average out the noise.
Points RunningMean(const Points& series) {
  const size_t size = series.x.size(), stretches = std::min<size_t>(100, size);
  Points means;
  for (size_t k = 0; k < stretches; ++k) {
    const size_t from = k * size / stretches, to = (k + 1) * size / stretches;
    double sum = 0, count = 0;
    for (size_t i = from; i < to; ++i) {
      if (std::isfinite(series.y[i])) sum += series.y[i], ++count;
    }
    means.x.push_back((series.x[from] + series.x[to - 1]) / 2);
    means.y.push_back(sum / count);
  }
  return means;
}

// The size that 99.5 % of the values do not exceed.
double UsualSize(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return 0;
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - 1) * 995 / 1000);
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

// The residual of a signal. Its axis is no higher than the measured signal and no lower than three times its
// noise.
page::Panel ResidualPanel(const Points& measured, const Points& before, const Points& after, double noise,
                          bool keys) {
  const Points left_before = Left(measured, before), left_after = Left(measured, after);
  page::Range range;
  range.Include(measured.y);
  double size = std::max(UsualSize(left_before.y), UsualSize(left_after.y));
  if (range.high > range.low) size = std::min(size, range.high - range.low);
  size = std::max(size, 3 * noise);
  page::Panel panel;
  panel.y.label = "difference";
  panel.y.min = page::Range{-size, size}.WithMargin().low;
  panel.y.max = -panel.y.min;
  panel.curves = {Drawn("", left_before, kBefore, Weight::kFaint),
                  Drawn("", left_after, kAfter, Weight::kFaint),
                  Drawn("", RunningMean(left_before), kBefore, Weight::kStrong),
                  Drawn(keys ? "means" : "", RunningMean(left_after), kAfter, Weight::kStrong)};
  if (noise > 0) panel.bands = {{keys ? "twice the noise" : "", false, -2 * noise, 2 * noise}};
  return panel;
}

}  // namespace

std::optional<page::Figure> RunFigure(const Diagnosis& diagnosis, const RunCurves& run, bool si) {
  constexpr double kSignalShare = 0.58;
  page::Range time;
  time.Include(run.time);
  if (!(time.low < time.high) || run.curves.empty()) return std::nullopt;
  std::vector<page::Band> shaded;
  if (!diagnosis.location.empty()) {
    for (const Window& window : diagnosis.location.front().windows) {
      if (window.run == run.run) shaded.push_back({"", true, window.from, window.to});
    }
  }
  page::Figure figure{.caption = "", .panels = {}, .columns = 2, .width = 960, .panel_height = 124};
  for (const RunCurves::Curve& curve : run.curves) {
    const ShownUnit unit = UnitOf(curve.channel, diagnosis.model.units, si);
    const auto points = [&](const std::vector<double>& y) {
      return y.size() == run.time.size() ? Points{run.time, Scaled(y, unit.factor)} : Points{};
    };
    double noise = 0;
    for (const SignalGap& signal : diagnosis.signals) {
      if (signal.channel == curve.channel) noise = unit.factor * signal.noise;
    }
    const Points measured = points(curve.measured), before = points(curve.before),
                 after = points(curve.after);
    // The first row has the keys, the last one the numbers of the time axis.
    const bool first = figure.panels.empty(), last = &curve == &run.curves.back();
    using Keys = std::array<const char*, 3>;
    page::Panel panels[] = {
        SignalPanel(Label(ChannelName(curve.channel), unit.unit), measured, before, after,
                    first ? Keys{"measured", kBeforeLabel, kAfterLabel} : Keys{"", "", ""}),
        ResidualPanel(measured, before, after, noise, first)};
    panels[0].width = kSignalShare;
    panels[1].width = 1 - kSignalShare;
    for (page::Panel& panel : panels) {
      panel.x = {.label = last ? "time (s)" : "", .min = time.low, .max = time.high, .numbers = last};
      panel.bands.insert(panel.bands.begin(), shaded.begin(), shaded.end());
    }
    if (first && !shaded.empty()) panels[0].bands[0].label = "largest disagreement";
    figure.panels.insert(figure.panels.end(), std::begin(panels), std::end(panels));
  }
  return figure;
}

page::Figure StretchFigure(const FoundStretch& stretch, const UnitSystem& units, bool si) {
  const ShownUnit unit = UnitOf(stretch.channel, units, si);
  const auto points = [&](const std::vector<double>& values) {
    return Points{stretch.time, Scaled(values, unit.factor)};
  };
  page::Panel panel = SignalPanel(Label(ChannelName(stretch.channel), unit.unit), points(stretch.measured),
                                  points(stretch.without), points(stretch.with),
                                  {"measured", "without the effect", "with it"});
  panel.x = {.label = "time (s)", .min = stretch.time.front(), .max = stretch.time.back()};
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 180};
}

}  // namespace hydro::diagnose
