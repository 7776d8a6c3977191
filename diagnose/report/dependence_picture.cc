// What residuals depend on.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/picture_parts.h"
#include "diagnose/report/report_pictures.h"

namespace hydro::diagnose {
namespace {

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
    return ScaledResiduals(*p2, *p1, 1);
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
Points Thinned(const Points& points, size_t most) {
  Points some;
  const size_t stride = std::max<size_t>(1, (points.x.size() + most - 1) / most);
  for (size_t i = 0; i < points.x.size(); i += stride) {
    some.x.push_back(points.x[i]);
    some.y.push_back(points.y[i]);
  }
  return some;
}

// A quantity that residuals may depend on.
struct Against {
  std::string name, label;
  double factor;
};

// The quantities that were measured.
std::vector<Against> ChooseAgainst(const Diagnosis& diagnosis, bool si) {
  const ShownUnit pressure = UnitOf(model::Channel::kP1, diagnosis.model.units, si);
  const ShownUnit arm = UnitOf(model::Channel::kArmAngle, diagnosis.model.units, si);
  const std::array<Against, 4> all = {{{"speed", "motor speed (rad/s)", 1},
                                       {"dp", "p_2 - p_1 (" + pressure.unit + ")", pressure.factor},
                                       {"angle", "arm angle (" + arm.unit + ")", arm.factor},
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
  const ShownUnit unit = UnitOf(channel, diagnosis.model.units, si);
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
        const std::vector<double> left = ScaledResiduals(curve.measured, *simulated, unit.factor);
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
      DrawnCurve(label(kBeforeLabel), Thinned(before, kMostDots), kBefore, Weight::kFaint, Stroke::kPoints),
      DrawnCurve(label(kAfterLabel), Thinned(after, kMostDots), kAfter, Weight::kFaint, Stroke::kPoints),
      DrawnCurve(label("mean, model as given"), BinMeans(before, range), kBefore, Weight::kStrong),
      DrawnCurve(label("mean, with what was found"), BinMeans(after, range), kAfter, Weight::kStrong)};
  SetRange(panel.y, ResidualRange(before, after, measured_size, noise));
  if (noise > 0) panel.bands = {{label(kNoiseLabel), false, -2 * noise, 2 * noise}};
  return panel;
}

}  // namespace

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
      if (k == 0) panel.y.label = LabelOf(channel, UnitOf(channel, diagnosis.model.units, si).unit);
      figure.panels.push_back(std::move(panel));
    }
  }
  return figure;
}

}  // namespace hydro::diagnose
