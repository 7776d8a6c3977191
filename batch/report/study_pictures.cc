#include "batch/report/study_pictures.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/number_text.h"
#include "page/heat_map.h"

namespace hydro::batch {
namespace {

constexpr size_t kMostPanels = 12;

struct Histogram {
  double low = 0, width = 1;
  std::vector<double> counts;
};

// Bins as wide as Freedman and Diaconis (1981) advise, between 8 and 60 of them.
Histogram HistogramOf(const std::vector<double>& sorted) {
  Histogram histogram;
  const double low = sorted.front(), high = sorted.back();
  if (!(high > low)) return {low - 0.5, 1, {static_cast<double>(sorted.size())}};
  if (!std::isfinite(high - low))
    return {low, high, {static_cast<double>(sorted.size())}};  // no bin can be that wide
  const double spread = Quantile(sorted, 0.75) - Quantile(sorted, 0.25);
  const double advised = 2 * spread / std::cbrt(static_cast<double>(sorted.size()));
  const double bins = advised > 0 ? std::ceil((high - low) / advised) : 20;
  const auto count = static_cast<size_t>(std::clamp(bins, 8.0, 60.0));
  histogram.low = low;
  histogram.width = (high - low) / static_cast<double>(count);
  histogram.counts.assign(count, 0);
  for (const double value : sorted)
    histogram.counts[std::min(static_cast<size_t>((value - low) / histogram.width), count - 1)] += 1;
  return histogram;
}

page::Panel DistributionPanel(const NumberColumn& column) {
  std::vector<double> sorted = column.values;
  std::ranges::sort(sorted);
  const Histogram histogram = HistogramOf(sorted);
  page::Panel panel;
  panel.x.label = column.Label();
  panel.y.label = "cases";
  panel.y.min = 0;
  page::Curve bars;
  bars.stroke = page::Stroke::kBars;
  for (size_t i = 0; i <= histogram.counts.size(); ++i) {
    bars.x.push_back(histogram.low + static_cast<double>(i) * histogram.width);
    bars.y.push_back(i < histogram.counts.size() ? histogram.counts[i] : 0);
  }
  panel.y.max = 1.08 * *std::ranges::max_element(histogram.counts);
  panel.curves.push_back(bars);
  if (sorted.back() > sorted.front()) {
    if (column.of->smaller_is_worse) std::ranges::reverse(sorted);
    if (const auto median = NoWorse(column, sorted, 0.5)) panel.rules.push_back({"median", true, *median});
    if (const auto most = NoWorse(column, sorted, 0.95)) panel.rules.push_back({"95 %", true, *most});
  }
  return panel;
}

std::vector<std::string> Names(const std::vector<double>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const double value : values) names.push_back(ShortNumber(value));
  return names;
}

}  // namespace

std::vector<size_t> WorstPlaces(const NumberColumn& column, size_t count) {
  std::vector<size_t> places(column.values.size());
  std::iota(places.begin(), places.end(), size_t{0});
  const auto worse = [&](size_t a, size_t b) {
    if (column.values[a] != column.values[b])
      return (column.values[a] > column.values[b]) != column.of->smaller_is_worse;
    return a < b;
  };
  count = std::min(count, places.size());
  std::partial_sort(places.begin(), places.begin() + static_cast<ptrdiff_t>(count), places.end(), worse);
  places.resize(count);
  return places;
}

std::optional<page::Figure> DistributionsFigure(const StudyNumbers& numbers) {
  page::Figure figure;
  for (const NumberColumn& column : numbers.columns()) {
    if (!column.values.empty() && figure.panels.size() < kMostPanels)
      figure.panels.push_back(DistributionPanel(column));
  }
  if (figure.panels.empty()) return std::nullopt;
  figure.columns = figure.panels.size() == 1 ? 1 : 2;
  figure.panel_height = 190;
  figure.caption =
      "How the cases spread. Dashed: the median, and the value that one case in twenty is worse than.";
  if (numbers.any_without())
    figure.caption += " Cases without the number are not drawn; they count as worse than any with it.";
  return figure;
}

std::optional<page::Figure> WorstFigure(const StudyNumbers& numbers) {
  const NumberColumn* column = numbers.worst();
  if (column == nullptr || column->values.size() < 2) return std::nullopt;
  std::vector<double> sorted = column->values;
  std::ranges::sort(sorted);
  if (column->of->smaller_is_worse) std::ranges::reverse(sorted);
  const auto share = [&](size_t place) {
    return 100 * (static_cast<double>(place) + 0.5) / static_cast<double>(column->all());
  };
  page::Curve curve;
  for (size_t i = 0; i < sorted.size(); ++i) {
    curve.x.push_back(share(i));
    curve.y.push_back(sorted[i]);
  }
  page::Panel panel;
  panel.x = {.label = "cases that are no worse, %", .min = 0, .max = 104};
  panel.y.label = column->Label();
  panel.curves.push_back(curve);
  const std::vector<size_t> places = WorstPlaces(*column, 3);
  for (size_t i = 0; i < places.size(); ++i) {
    panel.notes.push_back({"case " + std::to_string(column->cases[places[i]]), share(sorted.size() - 1 - i),
                           column->values[places[i]]});
  }
  page::Figure figure;
  figure.caption =
      fmt::format("{} of all cases in order; the worst three that have one are named.", column->of->name);
  if (column->without_count > 0)
    figure.caption +=
        fmt::format(" {} of {} have none: the curve ends before them.", column->without_count, column->all());
  figure.panels = {panel};
  figure.panel_height = 260;
  return figure;
}

std::optional<page::Figure> SurfaceFigure(const StudyNumbers& numbers) {
  const Surface& surface = numbers.surface();
  if (!surface.there()) return std::nullopt;
  page::HeatMap map;
  map.x_label = surface.x.key;
  map.y_label = surface.y.key;
  map.value_label = surface.of->unit.empty() ? surface.of->name : surface.of->name + ", " + surface.of->unit;
  map.x_names = Names(surface.x.centres);
  map.y_names = Names(surface.y.centres);
  bool any = false;
  double most = 0;
  for (size_t i = 0; i < surface.sums.size(); ++i) {
    const double count = surface.counts[i];
    any = any || count > 0;
    most = std::max(most, count);
    map.values.push_back(count > 0 ? surface.sums[i] / count : std::numeric_limits<double>::quiet_NaN());
  }
  if (!any) return std::nullopt;
  page::Figure figure;
  figure.drawing = page::HeatMapDrawing(map);
  const bool gaps = std::ranges::any_of(surface.counts, [](double count) { return count == 0; });
  const NumberColumn& column = numbers.columns()[surface.number];
  figure.caption = fmt::format(
      "{} over {} and {}{}{}{}.", surface.of->name, surface.x.key, surface.y.key,
      most > 1 ? ", the mean of the cases in each cell" : "", gaps ? "; white: no case with this number" : "",
      column.without_count > 0 ? fmt::format("; {} cases have none and are left out", column.without_count)
                               : "");
  return figure;
}

}  // namespace hydro::batch
