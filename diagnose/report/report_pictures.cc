#include "diagnose/report/report_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnose/data/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "page/range.h"

namespace hydro::diagnose {
namespace {

constexpr double kPageWidth = 960;
constexpr double kRowHeight = 104;

// Colours of the palette; they mean the same throughout the report.
constexpr int kAfter = 0, kBefore = 1, kRefit = 5;

constexpr char kBeforeLabel[] = "model as given";
constexpr char kAfterLabel[] = "with what was found";
constexpr char kNoiseLabel[] = "twice the noise";

struct Points {
  std::vector<double> x, y;
};

std::vector<double> Scaled(const std::vector<double>& values, double factor) {
  std::vector<double> scaled = values;
  for (double& value : scaled) value *= factor;
  return scaled;
}

// measured - simulated, scaled; empty without a simulation.
std::vector<double> Left(const std::vector<double>& measured, const std::vector<double>& simulated,
                         double factor) {
  std::vector<double> left;
  if (simulated.size() != measured.size()) return left;
  for (size_t i = 0; i < measured.size(); ++i) left.push_back(factor * (measured[i] - simulated[i]));
  return left;
}

// The size that 99.5 % of the values stay below.
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

double NoiseOf(const Diagnosis& diagnosis, model::Channel channel) {
  for (const SignalGap& signal : diagnosis.signals) {
    if (signal.channel == channel) return signal.noise;
  }
  return 0;
}

std::string WithBlanks(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string LabelOf(model::Channel channel, const std::string& unit) {
  return WithBlanks(ChannelName(channel)) + " (" + unit + ")";
}

void SetRange(page::Axis& axis, const page::Range& range) {
  axis.min = range.low;
  axis.max = range.high;
}

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

// The range of residuals, limited to the size of the measured signal.
page::Range ResidualRange(const Points& before, const Points& after, double measured_size, double noise) {
  double size = std::max(UsualSize(before.y), UsualSize(after.y));
  if (measured_size > 0) size = std::min(size, measured_size);
  size = std::max(size, 3 * noise);
  return page::Range{-size, size}.WithMargin();
}

double SizeOf(const std::vector<double>& values) {
  page::Range range;
  range.Include(values);
  return range.empty() ? 0 : range.high - range.low;
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

// A quantity that residuals may depend on, over a run's time; nothing where it was not measured.
std::optional<std::vector<double>> Quantity(const RunCurves& run, const std::string& name) {
  if (name == "voltage") {
    if (run.voltage.size() != run.time.size()) return std::nullopt;
    return run.voltage;
  }
  const auto find = [&](model::Channel channel) -> const std::vector<double>* {
    for (const RunCurves::Curve& curve : run.curves) {
      if (curve.channel == channel) return &curve.measured;
    }
    return nullptr;
  };
  if (name == "dp") {
    const std::vector<double>* p1 = find(model::Channel::kP1);
    const std::vector<double>* p2 = find(model::Channel::kP2);
    if (p1 == nullptr || p2 == nullptr) return std::nullopt;
    return Left(*p2, *p1, 1);
  }
  const std::vector<double>* values =
      find(name == "speed" ? model::Channel::kMotorSpeed : model::Channel::kArmAngle);
  if (values == nullptr) return std::nullopt;
  return *values;
}

// Means of y in bins of x, leaving out bins with few points.
Points BinMeans(const Points& points, const page::Range& range) {
  constexpr size_t kBins = 18;
  std::array<double, kBins> x{}, y{};
  std::array<size_t, kBins> count{};
  size_t all = 0;
  for (size_t i = 0; i < points.x.size(); ++i) {
    if (!std::isfinite(points.x[i]) || !std::isfinite(points.y[i])) continue;
    const double part = (points.x[i] - range.low) / (range.high - range.low);
    const size_t bin = std::min(kBins - 1, static_cast<size_t>(std::max(0.0, part) * kBins));
    x[bin] += points.x[i];
    y[bin] += points.y[i];
    ++count[bin];
    ++all;
  }
  Points means;
  for (size_t bin = 0; bin < kBins; ++bin) {
    if (count[bin] == 0 || 500 * count[bin] < all) continue;
    means.x.push_back(x[bin] / static_cast<double>(count[bin]));
    means.y.push_back(y[bin] / static_cast<double>(count[bin]));
  }
  return means;
}

// At most `most` of the points, evenly spaced.
Points Some(const Points& points, size_t most) {
  Points some;
  const size_t stride = std::max<size_t>(1, (points.x.size() + most - 1) / most);
  for (size_t i = 0; i < points.x.size(); i += stride) {
    some.x.push_back(points.x[i]);
    some.y.push_back(points.y[i]);
  }
  return some;
}

page::Curve Drawn(const std::string& label, const Points& points, int colour, page::Weight weight,
                  page::Stroke stroke = page::Stroke::kLine) {
  page::Curve curve = page::Line(label, points.x, points.y, colour, stroke);
  curve.weight = weight;
  return curve;
}

// One signal of a run: measured and simulated, then the residuals. The first row of a picture has the keys,
// the last one the numbers of the time axis.
std::array<page::Panel, 2> SignalPanels(const Diagnosis& diagnosis, const RunCurves& run,
                                        const RunCurves::Curve& curve, const page::Range& time, bool si,
                                        bool first, bool last) {
  constexpr double kSignalShare = 0.58;
  const ShownUnit unit = UnitOf(curve.channel, si);
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
  signals.curves = {Drawn(label("measured"), measured, 0, Weight::kBackdrop),
                    Drawn(label(kBeforeLabel), before, kBefore, Weight::kNormal),
                    Drawn(label(kAfterLabel), after, kAfter, Weight::kNormal)};
  SetRange(signals.y, RangeOf(measured, before, after));

  residuals.width = 1 - kSignalShare;
  residuals.y.label = "measured - model";
  if (noise > 0) residuals.bands.push_back({label(kNoiseLabel), false, -2 * noise, 2 * noise});
  const Points left_before = over_time(Left(curve.measured, curve.before, unit.factor));
  const Points left_after = over_time(Left(curve.measured, curve.after, unit.factor));
  residuals.curves = {Drawn("", left_before, kBefore, Weight::kFaint),
                      Drawn("", left_after, kAfter, Weight::kFaint),
                      Drawn("", RunningMean(left_before), kBefore, Weight::kStrong),
                      Drawn(label("means"), RunningMean(left_after), kAfter, Weight::kStrong)};
  SetRange(residuals.y, ResidualRange(left_before, left_after, SizeOf(measured.y), noise));
  return {signals, residuals};
}

// A quantity that residuals may depend on.
struct Against {
  std::string name, label;
  double factor;
};

// The quantities that were measured.
std::vector<Against> ChooseAgainst(const Diagnosis& diagnosis, bool si) {
  const ShownUnit pressure = UnitOf(model::Channel::kP1, si);
  const std::array<Against, 4> all = {{{"speed", "motor speed (rad/s)", 1},
                                       {"dp", "p_2 - p_1 (" + pressure.unit + ")", pressure.factor},
                                       {"angle", "arm angle (rad)", 1},
                                       {"voltage", "voltage (V)", 1}}};
  std::vector<Against> chosen;
  for (const Against& against : all) {
    const bool there =
        std::any_of(diagnosis.curves.begin(), diagnosis.curves.end(),
                    [&](const RunCurves& run) { return Quantity(run, against.name).has_value(); });
    if (there) chosen.push_back(against);
  }
  return chosen;
}

std::vector<model::Channel> ChannelsOf(const Diagnosis& diagnosis) {
  std::vector<model::Channel> channels;
  for (size_t c = 0; c < model::kChannels; ++c) {
    const model::Channel channel = static_cast<model::Channel>(c);
    const bool there =
        std::any_of(diagnosis.curves.begin(), diagnosis.curves.end(), [&](const RunCurves& run) {
          return std::any_of(run.curves.begin(), run.curves.end(),
                             [&](const RunCurves::Curve& curve) { return curve.channel == channel; });
        });
    if (there) channels.push_back(channel);
  }
  return channels;
}

page::Panel DependencePanel(const Diagnosis& diagnosis, model::Channel channel, const Against& against,
                            bool si, bool first, bool last) {
  constexpr size_t kMostDots = 400;
  const ShownUnit unit = UnitOf(channel, si);
  const double noise = unit.factor * NoiseOf(diagnosis, channel);
  Points before, after;
  double measured_size = 0;
  for (const RunCurves& run : diagnosis.curves) {
    const std::optional<std::vector<double>> x = Quantity(run, against.name);
    if (!x) continue;
    for (const RunCurves::Curve& curve : run.curves) {
      if (curve.channel != channel) continue;
      measured_size = std::max(measured_size, unit.factor * SizeOf(curve.measured));
      const std::vector<double> scaled = Scaled(*x, against.factor);
      for (auto [points, simulated] : {std::pair{&before, &curve.before}, {&after, &curve.after}}) {
        const std::vector<double> left = Left(curve.measured, *simulated, unit.factor);
        if (left.size() != scaled.size()) continue;
        points->x.insert(points->x.end(), scaled.begin(), scaled.end());
        points->y.insert(points->y.end(), left.begin(), left.end());
      }
    }
  }
  page::Range range;
  range.Include(before.x);
  range.Include(after.x);
  range = range.WithMargin();
  const auto label = [first](const char* text) { return first ? text : ""; };
  using page::Stroke, page::Weight;
  page::Panel panel;
  panel.x = {.label = last ? against.label : "", .min = range.low, .max = range.high, .numbers = last};
  panel.curves = {
      Drawn(label(kBeforeLabel), Some(before, kMostDots), kBefore, Weight::kFaint, Stroke::kPoints),
      Drawn(label(kAfterLabel), Some(after, kMostDots), kAfter, Weight::kFaint, Stroke::kPoints),
      Drawn(label("mean, model as given"), BinMeans(before, range), kBefore, Weight::kStrong),
      Drawn(label("mean, with what was found"), BinMeans(after, range), kAfter, Weight::kStrong)};
  SetRange(panel.y, ResidualRange(before, after, measured_size, noise));
  if (noise > 0) panel.bands = {{label(kNoiseLabel), false, -2 * noise, 2 * noise}};
  return panel;
}

struct GapRow {
  std::string name;
  BeforeAfter gap;
};

std::vector<GapRow> GapRows(const Diagnosis& diagnosis) {
  std::vector<GapRow> rows = {{"all signals, held out", diagnosis.held_out},
                              {"all signals, fitted", diagnosis.fit}};
  for (const SignalGap& signal : diagnosis.signals) {
    if (!(signal.noise > 0)) continue;
    const BeforeAfter& gap = signal.held_out;
    rows.push_back({WithBlanks(ChannelName(signal.channel)) + ", held out",
                    {gap.before / signal.noise, gap.refit_only / signal.noise, gap.after / signal.noise}});
  }
  return rows;
}

}  // namespace

page::Figure GapFigure(const Diagnosis& diagnosis) {
  const std::vector<GapRow> rows = GapRows(diagnosis);
  constexpr double kRow = 25;
  page::Panel panel;
  panel.x = {
      .label = "root-mean-square residual in noise standard deviations", .logarithmic = true, .min = 0.5};
  panel.y.min = 0.4 - static_cast<double>(rows.size());
  panel.y.max = 0.6;
  // The line from before to after.
  page::Curve way = page::Line("", {}, {}, kRefit);
  page::Curve before = page::Line(kBeforeLabel, {}, {}, kBefore, page::Stroke::kPoints);
  page::Curve refit = page::Line("its own parameters refitted", {}, {}, kRefit, page::Stroke::kPoints);
  page::Curve after = page::Line(kAfterLabel, {}, {}, kAfter, page::Stroke::kPoints);
  double highest = 10;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double y = -static_cast<double>(i);
    panel.y.ticks.push_back({y, rows[i].name});
    const BeforeAfter& gap = rows[i].gap;
    // Values below the axis are shown at its end.
    const auto shown = [](double value) { return std::isfinite(value) ? std::max(value, 0.5) : value; };
    for (auto [curve, value] :
         {std::pair{&before, gap.before}, {&refit, gap.refit_only}, {&after, gap.after}}) {
      curve->x.push_back(shown(value));
      curve->y.push_back(y);
      if (std::isfinite(value)) highest = std::max(highest, value);
    }
    way.x.insert(way.x.end(), {shown(gap.before), shown(gap.after), std::nan("")});
    way.y.insert(way.y.end(), {y, y, std::nan("")});
  }
  way.weight = page::Weight::kFaint;
  for (page::Curve* curve : {&before, &refit, &after}) curve->weight = page::Weight::kStrong;
  panel.x.max = 1.15 * highest;
  panel.rules = {{"noise floor", true, 1}};
  panel.curves = {way, before, refit, after};
  return {.caption = "",
          .panels = {panel},
          .width = 760,
          .panel_height = kRow * static_cast<double>(rows.size()) + 5};
}

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

std::optional<page::Figure> DependenceFigure(const Diagnosis& diagnosis, bool si) {
  const std::vector<Against> columns = ChooseAgainst(diagnosis, si);
  const std::vector<model::Channel> channels = ChannelsOf(diagnosis);
  if (columns.empty() || channels.empty()) return std::nullopt;
  page::Figure figure{
      .caption = "",
      .panels = {},
      .columns = columns.size(),
      .width = columns.size() < 3 ? kPageWidth * static_cast<double>(columns.size()) / 3 : kPageWidth,
      .panel_height = kRowHeight};
  for (const model::Channel channel : channels) {
    for (size_t k = 0; k < columns.size(); ++k) {
      const bool first = k == 0 && channel == channels.front();
      page::Panel panel =
          DependencePanel(diagnosis, channel, columns[k], si, first, channel == channels.back());
      if (k == 0) panel.y.label = LabelOf(channel, UnitOf(channel, si).unit);
      figure.panels.push_back(std::move(panel));
    }
  }
  return figure;
}

page::Figure MissingTermFigure(const MissingTerm& term) {
  page::Panel panel;
  panel.x.label =
      WithBlanks(term.against) + (term.against_unit.empty() ? "" : " (" + term.against_unit + ")");
  panel.y.label = "missing in " + WithBlanks(term.balance) + " (" + term.unit + ")";
  page::Curve found = page::Line("", term.at, term.mean, kAfter, page::Stroke::kLinePoints);
  page::Range x, y;
  x.Include(term.at);
  y.Include(0.0);
  for (size_t i = 0; i < term.mean.size(); ++i) {
    const double error = i < term.error.size() ? 1.96 * term.error[i] : 0;
    found.y_low.push_back(term.mean[i] - error);
    found.y_high.push_back(term.mean[i] + error);
  }
  y.Include(found.y_low);
  y.Include(found.y_high);
  SetRange(panel.x, x.WithMargin());
  SetRange(panel.y, y.WithMargin());
  panel.curves = {found};
  return {.caption = "", .panels = {panel}, .width = 560, .panel_height = 180};
}

}  // namespace hydro::diagnose
