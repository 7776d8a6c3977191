#include "page/chart.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

#include "page/curve_thinning.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

// Around the axes' rectangle.
constexpr double kLeft = 58, kRight = 8, kTop = 8, kBottomWithNumbers = 32, kBottom = 8;

std::string NumberAt(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Maps the axes' rectangle, whose upper left corner is (0, 0).
struct Frame {
  const Chart& chart;
  double width, height;

  double X(double x) const { return (x - chart.x.low) / (chart.x.high - chart.x.low) * width; }
  // Far outside is far enough: SVG's readers stumble over huge coordinates.
  double Y(double y) const {
    const double pixels = (1 - (y - chart.y.low) / (chart.y.high - chart.y.low)) * height;
    return std::clamp(pixels, -10 * height, 11 * height);
  }
};

std::string Rectangle(const std::string& style, double x, double y, double width, double height) {
  return "<rect class=\"" + style + "\" x=\"" + Pixels(x) + "\" y=\"" + Pixels(y) + "\" width=\"" +
         Pixels(std::max(width, 0.0)) + "\" height=\"" + Pixels(std::max(height, 0.0)) + "\"/>\n";
}

std::string Stroke(const std::string& style, double x1, double y1, double x2, double y2) {
  return "<path class=\"" + style + "\" d=\"M" + Pixels(x1) + " " + Pixels(y1) + "L" + Pixels(x2) + " " +
         Pixels(y2) + "\"/>\n";
}

std::string Text(const std::string& style, double x, double y, const std::string& text) {
  return "<text class=\"" + style + "\" x=\"" + Pixels(x) + "\" y=\"" + Pixels(y) + "\">" + TypesetSvg(text) +
         "</text>\n";
}

std::string DrawLine(const ChartSeries& line, const Frame& frame) {
  std::string path;
  bool pen_up = true;
  const std::vector<size_t> points =
      ThinLine(line.x, line.y, [&](double x) { return std::floor(2 * frame.X(x)); });
  for (const size_t i : points) {
    if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) {
      pen_up = true;
      continue;
    }
    path += (pen_up ? "M" : "L") + Pixels(frame.X(line.x[i])) + " " + Pixels(frame.Y(line.y[i]));
    pen_up = false;
  }
  return path.empty() ? "" : "<path class=\"line " + line.style + "\" d=\"" + path + "\"/>\n";
}

std::string DrawDots(const ChartSeries& dots, const Frame& frame) {
  // One path of zero-length strokes with round ends instead of thousands of circles.
  std::string path, bars;
  for (size_t i = 0; i < dots.x.size(); ++i) {
    if (!std::isfinite(dots.x[i]) || !std::isfinite(dots.y[i])) continue;
    path += "M" + Pixels(frame.X(dots.x[i])) + " " + Pixels(frame.Y(dots.y[i])) + "h0";
    if (i >= dots.error.size() || !std::isfinite(dots.error[i])) continue;
    bars += "M" + Pixels(frame.X(dots.x[i])) + " " + Pixels(frame.Y(dots.y[i] - dots.error[i])) + "V" +
            Pixels(frame.Y(dots.y[i] + dots.error[i]));
  }
  std::string out;
  if (!bars.empty()) out += "<path class=\"bar " + dots.style + "\" d=\"" + bars + "\"/>\n";
  if (!path.empty()) out += "<path class=\"dots " + dots.style + "\" d=\"" + path + "\"/>\n";
  return out;
}

}  // namespace

void ChartRange::Include(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

void ChartRange::Include(const std::vector<double>& values) {
  for (const double value : values) Include(value);
}

ChartRange ChartRange::WithMargin() const {
  if (!(low <= high)) return {-1, 1};
  const double size = high - low;
  const double margin = size > 0 ? size / 18 : std::max(1e-6, std::abs(low) / 10);
  return {low - margin, high + margin};
}

ChartRange ChartRange::Empty() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {kInfinity, -kInfinity};
}

std::vector<double> RoundNumbers(const ChartRange& range, int count) {
  const double rough = (range.high - range.low) / count;
  if (!(rough > 0) || !std::isfinite(rough)) return {};
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  const double digit = rough / decade;
  const double step = decade * (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10);
  std::vector<double> numbers;
  const double first = std::ceil(range.low / step - 1e-9), last = std::floor(range.high / step + 1e-9);
  for (double k = first; k <= last; k += 1) numbers.push_back(k * step);
  return numbers;
}

std::string Pixels(double value) {
  char text[32];
  const double rounded = std::round(10 * value) / 10;
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, rounded == 0 ? 0.0 : rounded, std::chars_format::fixed);
  return error == std::errc() ? std::string(text, end) : "0";
}

std::string DrawChart(const Chart& chart, double left, double top) {
  const bool numbers = !chart.x_label.empty();
  const Frame frame{chart, chart.width - kLeft - kRight,
                    chart.height - kTop - (numbers ? kBottomWithNumbers : kBottom)};
  std::string out = "<g transform=\"translate(" + Pixels(left + kLeft) + " " + Pixels(top + kTop) + ")\">\n";
  // An <svg> in an <svg> cuts off what is outside of it.
  out += "<svg width=\"" + Pixels(frame.width) + "\" height=\"" + Pixels(frame.height) + "\">\n";
  for (const ChartRange& span : chart.spans) {
    const double from = frame.X(std::max(span.low, chart.x.low));
    const double to = frame.X(std::min(span.high, chart.x.high));
    // Thinner than a line it would not be seen.
    if (to >= from) out += Rectangle("span", from, 0, std::max(to - from, 1.0), frame.height);
  }
  if (chart.band > 0) {
    out += Rectangle("band", 0, frame.Y(chart.band), frame.width, frame.Y(-chart.band) - frame.Y(chart.band));
  }
  const std::vector<double> x_numbers =
      RoundNumbers(chart.x, std::max(3, static_cast<int>(frame.width / 60)));
  const std::vector<double> y_numbers =
      RoundNumbers(chart.y, std::max(2, static_cast<int>(frame.height / 22)));
  for (const double x : x_numbers) out += Stroke("grid", frame.X(x), 0, frame.X(x), frame.height);
  for (const double y : y_numbers) out += Stroke("grid", 0, frame.Y(y), frame.width, frame.Y(y));
  if (chart.zero_line) out += Stroke("zero", 0, frame.Y(0), frame.width, frame.Y(0));
  for (const ChartSeries& dots : chart.dots) out += DrawDots(dots, frame);
  for (const ChartSeries& line : chart.lines) out += DrawLine(line, frame);
  out += "</svg>\n" + Rectangle("frame", 0, 0, frame.width, frame.height);

  const auto step = [](const std::vector<double>& all) { return all.size() > 1 ? all[1] - all[0] : 1.0; };
  for (const double y : y_numbers) {
    out += Text("y", -5, frame.Y(y) + 3.5, NumberAt(y, step(y_numbers)));
  }
  if (numbers) {
    for (const double x : x_numbers) {
      out += Text("x", frame.X(x), frame.height + 13, NumberAt(x, step(x_numbers)));
    }
    out += Text("x", frame.width / 2, frame.height + 27, chart.x_label);
  }
  if (!chart.y_label.empty()) {
    out += "<text class=\"x\" transform=\"translate(-45 " + Pixels(frame.height / 2) + ") rotate(-90)\">" +
           TypesetSvg(chart.y_label) + "</text>\n";
  }
  return out + "</g>\n";
}

}  // namespace hydro::page
