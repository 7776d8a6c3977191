#include "runs/timing/timing_plots.h"

#include <algorithm>
#include <cmath>

#include "page/plot.h"

namespace hydro::timing {
namespace {

page::Figure SmallFigure(page::Panel panel, const std::string& caption) {
  return {.caption = caption, .panels = {std::move(panel)}, .width = 430, .panel_height = 150};
}

}  // namespace

std::optional<page::Figure> HistogramFigure(const TimingHistogram& histogram, double scale,
                                            const std::string& x_label, const std::string& caption) {
  if (histogram.ranges.empty()) return std::nullopt;
  // A range ends where the next whole number begins.
  const auto begin = [&](const TimingHistogram::Range& range) {
    return scale * std::max(0.5, static_cast<double>(range.first) - 0.5);
  };
  const auto end = [&](const TimingHistogram::Range& range) {
    return scale * (static_cast<double>(range.last) + 0.5);
  };
  page::Curve bars;
  bars.stroke = page::Stroke::kBars;
  bars.colour = 0;
  double most = 1;
  for (const TimingHistogram::Range& range : histogram.ranges) {
    bars.x.insert(bars.x.end(), {begin(range), end(range)});
    bars.y.insert(bars.y.end(), {static_cast<double>(range.count), std::nan("")});
    most = std::max(most, static_cast<double>(range.count));
  }
  const double low = bars.x.front();
  page::Panel panel;
  panel.x = {.label = x_label, .logarithmic = true, .min = low / 1.1, .max = bars.x.back() * 1.1};
  panel.y = {.label = "count", .logarithmic = true, .min = 0.5, .max = most * 1.5};
  panel.curves = {bars};
  for (const auto& [percent, name] :
       {std::pair{50.0, "p50"}, {99.0, "p99"}, {99.9, "p99.9"}, {100.0, "max"}}) {
    panel.rules.push_back({name, true, std::max(scale * histogram.Percentile(percent), low)});
  }
  return SmallFigure(std::move(panel), caption);
}

std::optional<page::Figure> TimeFigure(const std::vector<double>& times_s, const std::vector<TimeLine>& lines,
                                       const std::string& y_label, const std::string& caption) {
  page::Range values;
  for (const TimeLine& line : lines) values.Include(line.values);
  if (times_s.empty() || values.empty()) return std::nullopt;
  page::Panel panel;
  panel.x = {
      .label = "time, s", .min = std::min(0.0, times_s.front()), .max = std::max(times_s.back(), 1e-3)};
  panel.y.label = y_label;
  if (values.low > 0 && values.high > 30 * values.low) {
    panel.y.logarithmic = true;
  } else {
    panel.y.min = std::min(0.0, values.low);
    panel.y.max = values.high > 0 ? 1.1 * values.high : 1;
  }
  for (size_t i = 0; i < lines.size(); ++i) {
    const page::Stroke stroke = times_s.size() == 1 ? page::Stroke::kPoints : page::Stroke::kLine;
    panel.curves.push_back(page::Line(lines[i].name, times_s, lines[i].values, static_cast<int>(i), stroke));
  }
  return SmallFigure(std::move(panel), caption);
}

}  // namespace hydro::timing
