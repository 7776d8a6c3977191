#include "diagnose/report/report_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/short_number.h"
#include "diagnose/data/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "page/chart.h"
#include "page/typeset.h"

namespace hydro::diagnose {
namespace {

constexpr double kPageWidth = 960;
constexpr double kLegendHeight = 22;

std::string Figure(double width, double height, const std::string& says, const std::string& drawing) {
  return "<figure>\n<svg viewBox=\"0 0 " + page::Pixels(width) + " " + page::Pixels(height) +
         "\" style=\"width:" + page::Pixels(width) + "px\" role=\"img\" aria-label=\"" +
         page::EscapeMarkup(says) + "\">\n" + drawing + "</svg>\n</figure>\n";
}

struct LegendEntry {
  const char* drawing;  // "line before", "dots after", "rect band"
  const char* says;
};

std::string Legend(const std::vector<LegendEntry>& entries, double left) {
  std::string out;
  double x = left;
  for (const LegendEntry& entry : entries) {
    const std::string drawing = entry.drawing;
    const std::string at = page::Pixels(x);
    if (drawing.starts_with("rect ")) {
      out +=
          "<rect class=\"" + drawing.substr(5) + "\" x=\"" + at + "\" y=\"5\" width=\"22\" height=\"10\"/>\n";
    } else if (drawing.starts_with("dots ")) {
      out += "<path class=\"" + drawing + "\" d=\"M" + page::Pixels(x + 11) + " 10h0\"/>\n";
    } else {
      out += "<path class=\"" + drawing + "\" d=\"M" + at + " 10h22\"/>\n";
    }
    out +=
        "<text x=\"" + page::Pixels(x + 28) + "\" y=\"13.5\">" + page::TypesetSvg(entry.says) + "</text>\n";
    x += 28 + 11 * page::TextWidth(entry.says) + 26;
  }
  return out;
}

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

// Below which nine hundred and ninety-five of a thousand sizes are.
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

std::string LabelOf(model::Channel channel, const std::string& unit) {
  std::string name = ChannelName(channel);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + " (" + unit + ")";
}

// What a simulation that runs away shows counts up to the size of what was measured.
page::ChartRange RangeOf(const page::ChartSeries& measured, const page::ChartSeries& before,
                         const page::ChartSeries& after) {
  page::ChartRange range = page::ChartRange::Empty();
  range.Include(measured.y);
  const double size = range.high - range.low;
  const page::ChartRange most{range.low - size, range.high + size};
  for (const page::ChartSeries* series : {&before, &after}) {
    for (const double y : series->y) {
      if (std::isfinite(y)) range.Include(std::clamp(y, most.low, most.high));
    }
  }
  return range.WithMargin();
}

// Of residuals, which count up to the size of what was measured.
page::ChartRange ResidualRange(const page::ChartSeries& before, const page::ChartSeries& after,
                               double measured_size, double noise) {
  double size = std::max(UsualSize(before.y), UsualSize(after.y));
  if (measured_size > 0) size = std::min(size, measured_size);
  size = std::max(size, 3 * noise);
  return page::ChartRange{-size, size}.WithMargin();
}

double SizeOf(const std::vector<double>& values) {
  page::ChartRange range = page::ChartRange::Empty();
  range.Include(values);
  return range.low <= range.high ? range.high - range.low : 0;
}

// Means over stretches of time, through which noise does not show.
page::ChartSeries RunningMean(const std::string& style, const page::ChartSeries& series) {
  constexpr size_t kStretches = 100;
  page::ChartSeries means{style, {}, {}, {}};
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

// What residuals may depend on, over a run's time; nothing where it was not measured.
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

// Means of y in bins of x, left out where there are few points.
page::ChartSeries BinMeans(const std::string& style, const page::ChartSeries& points,
                           const page::ChartRange& range) {
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
  page::ChartSeries means{style, {}, {}, {}};
  for (size_t bin = 0; bin < kBins; ++bin) {
    if (count[bin] == 0 || 500 * count[bin] < all) continue;
    means.x.push_back(x[bin] / static_cast<double>(count[bin]));
    means.y.push_back(y[bin] / static_cast<double>(count[bin]));
  }
  return means;
}

// At most `most` of the points, evenly chosen.
page::ChartSeries Some(const page::ChartSeries& points, size_t most) {
  page::ChartSeries some{points.style, {}, {}, {}};
  const size_t stride = std::max<size_t>(1, (points.x.size() + most - 1) / most);
  for (size_t i = 0; i < points.x.size(); i += stride) {
    some.x.push_back(points.x[i]);
    some.y.push_back(points.y[i]);
  }
  return some;
}

struct GapRow {
  std::string says;
  BeforeAfter gap;
};

}  // namespace

std::string GapPicture(const Diagnosis& diagnosis) {
  std::vector<GapRow> rows = {{"all signals, held out", diagnosis.held_out},
                              {"all signals, fitted", diagnosis.fit}};
  for (const SignalGap& signal : diagnosis.signals) {
    if (!(signal.noise > 0)) continue;
    const BeforeAfter& gap = signal.held_out;
    std::string name = ChannelName(signal.channel);
    std::replace(name.begin(), name.end(), '_', ' ');
    rows.push_back({name + ", held out",
                    {gap.before / signal.noise, gap.refit_only / signal.noise, gap.after / signal.noise}});
  }
  constexpr double kLabel = 150, kRow = 24, kRight = 20, kWidth = 760;
  const double bottom = kLegendHeight + kRow * static_cast<double>(rows.size()) + 6;
  double highest = 10;
  for (const GapRow& row : rows) {
    for (const double value : {row.gap.before, row.gap.refit_only, row.gap.after}) {
      if (std::isfinite(value)) highest = std::max(highest, value);
    }
  }
  const double decades = std::log10(2 * highest);  // from 0.5
  const auto at = [&](double value) {
    return kLabel + std::clamp(std::log10(2 * value) / decades, 0.0, 1.0) * (kWidth - kLabel - kRight);
  };
  std::string out = Legend({{"dots big before", "model as given"},
                            {"dots big refit", "its own parameters refitted"},
                            {"dots big after", "with what was found"},
                            {"line floor", "noise floor"}},
                           kLabel);
  for (double decade = 1; decade <= highest; decade *= 10) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * decade;
      if (value > highest) break;
      const std::string x = page::Pixels(at(value));
      out += "<path class=\"grid\" d=\"M" + x + " " + page::Pixels(kLegendHeight) + "V" +
             page::Pixels(bottom) + "\"/>\n" + "<text class=\"x\" x=\"" + x + "\" y=\"" +
             page::Pixels(bottom + 14) + "\">" + ShortNumber(value) + "</text>\n";
    }
  }
  out += "<path class=\"line floor\" d=\"M" + page::Pixels(at(1)) + " " + page::Pixels(kLegendHeight) + "V" +
         page::Pixels(bottom) + "\"/>\n";
  for (size_t i = 0; i < rows.size(); ++i) {
    const double y = kLegendHeight + kRow * (static_cast<double>(i) + 0.5) + 3;
    const BeforeAfter& gap = rows[i].gap;
    out += "<text class=\"y\" x=\"" + page::Pixels(kLabel - 8) + "\" y=\"" + page::Pixels(y + 4) + "\">" +
           page::TypesetSvg(rows[i].says) + "</text>\n";
    if (std::isfinite(gap.before) && std::isfinite(gap.after)) {
      out += "<path class=\"zero\" d=\"M" + page::Pixels(at(gap.after)) + " " + page::Pixels(y) + "H" +
             page::Pixels(at(gap.before)) + "\"/>\n";
    }
    const std::pair<const char*, double> marks[] = {
        {"before", gap.before}, {"refit", gap.refit_only}, {"after", gap.after}};
    for (const auto& [style, value] : marks) {
      if (!std::isfinite(value)) continue;
      out += "<path class=\"dots big " + std::string(style) + "\" d=\"M" + page::Pixels(at(value)) + " " +
             page::Pixels(y) + "h0\"/>\n";
    }
  }
  out += "<text class=\"x\" x=\"" + page::Pixels((kLabel + kWidth) / 2) + "\" y=\"" +
         page::Pixels(bottom + 30) +
         "\">root-mean-square residual in noise standard deviations, logarithmic</text>\n";
  return Figure(kWidth, bottom + 36, "the gap before and after", out);
}

std::string RunPicture(const Diagnosis& diagnosis, const RunCurves& run, bool si) {
  constexpr double kSignals = 570, kResiduals = kPageWidth - kSignals, kRow = 128, kNumbers = 24;
  std::vector<page::ChartRange> spans;
  if (!diagnosis.location.empty()) {
    for (const Window& window : diagnosis.location.front().windows) {
      if (window.run == run.run) spans.push_back({window.from, window.to});
    }
  }
  page::ChartRange time = page::ChartRange::Empty();
  time.Include(run.time);
  if (!(time.low < time.high)) return "";

  std::vector<LegendEntry> legend = {{"line measured", "measured"},
                                     {"line before", "model as given"},
                                     {"line after", "with what was found"}};
  if (!spans.empty()) legend.push_back({"rect span", "where they disagree most"});
  std::string out = Legend(legend, 58) +
                    Legend({{"rect band", "twice the noise"}, {"line after mean", "means"}}, kSignals + 58);
  double top = kLegendHeight;
  for (size_t i = 0; i < run.curves.size(); ++i) {
    const RunCurves::Curve& curve = run.curves[i];
    const bool last = i + 1 == run.curves.size();
    const ShownUnit unit = UnitOf(curve.channel, si);
    const double noise = unit.factor * NoiseOf(diagnosis, curve.channel);
    const auto series = [&](const char* style, const std::vector<double>& y) {
      const bool there = y.size() == run.time.size();
      return page::ChartSeries{
          style, there ? run.time : std::vector<double>(), there ? y : std::vector<double>(), {}};
    };

    page::Chart signals;
    signals.width = kSignals;
    signals.height = last ? kRow + kNumbers : kRow;
    signals.y_label = LabelOf(curve.channel, unit.unit);
    signals.x_label = last ? "time (s)" : "";
    signals.x = time;
    signals.spans = spans;
    signals.lines = {series("measured", Scaled(curve.measured, unit.factor)),
                     series("before", Scaled(curve.before, unit.factor)),
                     series("after", Scaled(curve.after, unit.factor))};
    signals.y = RangeOf(signals.lines[0], signals.lines[1], signals.lines[2]);
    out += page::DrawChart(signals, 0, top);

    page::Chart residuals = signals;
    residuals.width = kResiduals;
    residuals.y_label = "measured - model";
    residuals.band = 2 * noise;
    residuals.zero_line = true;
    residuals.lines = {series("before faint", Left(curve.measured, curve.before, unit.factor)),
                       series("after faint", Left(curve.measured, curve.after, unit.factor))};
    residuals.y = ResidualRange(residuals.lines[0], residuals.lines[1], SizeOf(signals.lines[0].y), noise);
    residuals.lines.push_back(RunningMean("before mean", residuals.lines[0]));
    residuals.lines.push_back(RunningMean("after mean", residuals.lines[1]));
    out += page::DrawChart(residuals, kSignals, top);
    top += signals.height;
  }
  return Figure(kPageWidth, top + 4, "measured and simulated signals of " + run.run, out);
}

std::string DependencePicture(const Diagnosis& diagnosis, bool si) {
  if (diagnosis.curves.empty()) return "";
  const std::string pressure = UnitOf(model::Channel::kP1, si).unit;
  struct Against {
    std::string name, label;
    double factor;
  };
  const std::array<Against, 4> all = {
      {{"speed", "motor speed (rad/s)", 1},
       {"dp", "p_2 - p_1 (" + pressure + ")", UnitOf(model::Channel::kP1, si).factor},
       {"angle", "arm angle (rad)", 1},
       {"voltage", "voltage (V)", 1}}};
  std::vector<Against> columns;
  for (const Against& column : all) {
    const bool there =
        std::any_of(diagnosis.curves.begin(), diagnosis.curves.end(),
                    [&](const RunCurves& run) { return Quantity(run, column.name).has_value(); });
    if (there) columns.push_back(column);
  }
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
  if (columns.empty() || channels.empty()) return "";

  constexpr double kRow = 128, kNumbers = 24;
  const double width = kPageWidth / static_cast<double>(std::max<size_t>(3, columns.size()));
  std::string out = Legend({{"dots big before", "model as given"},
                            {"line before mean", "its mean"},
                            {"dots big after", "with what was found"},
                            {"line after mean", "its mean"},
                            {"rect band", "twice the noise"}},
                           58);
  double top = kLegendHeight;
  for (const model::Channel channel : channels) {
    const bool last = channel == channels.back();
    const ShownUnit unit = UnitOf(channel, si);
    const double noise = unit.factor * NoiseOf(diagnosis, channel);
    for (size_t k = 0; k < columns.size(); ++k) {
      page::ChartSeries before{"before", {}, {}, {}}, after{"after", {}, {}, {}};
      double measured_size = 0;
      for (const RunCurves& run : diagnosis.curves) {
        const std::optional<std::vector<double>> x = Quantity(run, columns[k].name);
        if (!x) continue;
        for (const RunCurves::Curve& curve : run.curves) {
          if (curve.channel != channel) continue;
          measured_size = std::max(measured_size, unit.factor * SizeOf(curve.measured));
          const std::vector<double> scaled = Scaled(*x, columns[k].factor);
          for (auto [series, simulated] : {std::pair{&before, &curve.before}, {&after, &curve.after}}) {
            const std::vector<double> left = Left(curve.measured, *simulated, unit.factor);
            if (left.size() != scaled.size()) continue;
            series->x.insert(series->x.end(), scaled.begin(), scaled.end());
            series->y.insert(series->y.end(), left.begin(), left.end());
          }
        }
      }
      page::Chart chart;
      chart.width = width;
      chart.height = last ? kRow + kNumbers : kRow;
      chart.x_label = last ? columns[k].label : "";
      chart.y_label = k == 0 ? LabelOf(channel, unit.unit) : "";
      page::ChartRange range = page::ChartRange::Empty();
      range.Include(before.x);
      range.Include(after.x);
      chart.x = range.WithMargin();
      chart.y = ResidualRange(before, after, measured_size, noise);
      chart.band = 2 * noise;
      chart.zero_line = true;
      chart.dots = {Some(before, 400), Some(after, 400)};
      chart.lines = {BinMeans("before mean", before, chart.x), BinMeans("after mean", after, chart.x)};
      out += page::DrawChart(chart, width * static_cast<double>(k), top);
    }
    top += last ? kRow + kNumbers : kRow;
  }
  return Figure(kPageWidth, top + 4, "residuals against what they may depend on", out);
}

std::string MissingTermPicture(const MissingTerm& term) {
  page::Chart chart;
  chart.width = 560;
  chart.height = 220;
  std::string against = term.against;
  std::replace(against.begin(), against.end(), '_', ' ');
  std::string balance = term.balance;
  std::replace(balance.begin(), balance.end(), '_', ' ');
  chart.x_label = against + (term.against_unit.empty() ? "" : " (" + term.against_unit + ")");
  chart.y_label = "missing in " + balance + " (" + term.unit + ")";
  page::ChartRange x = page::ChartRange::Empty(), y = page::ChartRange::Empty();
  x.Include(term.at);
  y.Include(0.0);
  page::ChartSeries dots{"found", term.at, term.mean, {}};
  for (size_t i = 0; i < term.mean.size(); ++i) {
    const double error = i < term.error.size() ? 1.96 * term.error[i] : 0;
    dots.error.push_back(error);
    y.Include(term.mean[i] - error);
    y.Include(term.mean[i] + error);
  }
  chart.x = x.WithMargin();
  chart.y = y.WithMargin();
  chart.zero_line = true;
  chart.dots = {dots};
  chart.lines = {{"found", term.at, term.mean, {}}};
  return Figure(chart.width, chart.height, "the missing term", page::DrawChart(chart, 0, 0));
}

}  // namespace hydro::diagnose
