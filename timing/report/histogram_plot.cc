#include "timing/report/histogram_plot.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace hydro::timing {
namespace {

constexpr double kWidth = 430, kHeight = 210;
constexpr double kLeft = 56, kRight = 12, kTop = 22, kBottom = 40;

std::string Number(double value) {
  const double size = std::abs(value);
  return size >= 1e4 && size < 1e9 ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

// One axis: from values to pixels, and where its ticks are.
struct Scale {
  double low, high;
  double from, to;  // pixels
  bool logarithmic;

  double At(double value) const {
    const double share = logarithmic
                             ? (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low))
                             : (value - low) / (high - low);
    return from + std::clamp(share, 0.0, 1.0) * (to - from);
  }

  std::vector<double> Ticks() const {
    std::vector<double> ticks;
    if (logarithmic) {
      const double decades = std::log10(high / low);
      for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10) {
        for (const double digit : {1.0, 2.0, 5.0}) {
          const double tick = digit * decade;
          if ((digit == 1 || decades < 2.2) && tick >= low * 0.999 && tick <= high * 1.001)
            ticks.push_back(tick);
        }
      }
      return ticks;
    }
    const double rough = (high - low) / 5, decade = std::pow(10, std::floor(std::log10(rough)));
    const double step = rough / decade > 5   ? 10 * decade
                        : rough / decade > 2 ? 5 * decade
                        : rough / decade > 1 ? 2 * decade
                                             : decade;
    for (double tick = std::ceil(low / step) * step; tick <= high + 1e-9 * step; tick += step) {
      ticks.push_back(std::abs(tick) < 1e-9 * step ? 0 : tick);
    }
    return ticks;
  }
};

std::string Axes(const Scale& x, const Scale& y, const std::string& x_label, const std::string& y_label) {
  std::string svg;
  for (const double tick : y.Ticks()) {
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text class=\"tick\" text-anchor=\"end\" "
        "x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        x.from, y.At(tick), x.to, x.from - 5, y.At(tick) + 3.5, Number(tick));
  }
  double free_from = -1e9;
  for (const double tick : x.Ticks()) {
    const double at = x.At(tick);
    svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}v4\"/>", at, y.from);
    if (at < free_from) continue;
    free_from = at + 34;
    svg += fmt::format("<text class=\"tick\" text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                       at, y.from + 16, Number(tick));
  }
  svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", x.from, y.from, x.to);
  svg += fmt::format("<text class=\"label\" text-anchor=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                     0.5 * (x.from + x.to), kHeight - 6, EscapeHtml(x_label));
  svg += fmt::format("<text class=\"label\" x=\"4\" y=\"12\">{}</text>\n", EscapeHtml(y_label));
  return svg;
}

std::string Wrap(const std::string& content, const std::string& title) {
  return fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n", kWidth,
                     kHeight, EscapeHtml(title), content);
}

}  // namespace

std::string EscapeHtml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string HistogramSvg(const TimingHistogram& histogram, double scale, const std::string& x_label) {
  if (histogram.ranges.empty()) return "";
  // A range ends where the next whole number would begin.
  const auto begin = [&](const TimingHistogram::Range& range) {
    return scale * std::max(0.5, static_cast<double>(range.first) - 0.5);
  };
  const auto end = [&](const TimingHistogram::Range& range) {
    return scale * (static_cast<double>(range.last) + 0.5);
  };
  int64_t most = 1;
  for (const TimingHistogram::Range& range : histogram.ranges) most = std::max(most, range.count);
  const double low = begin(histogram.ranges.front()), high = end(histogram.ranges.back());
  const Scale x{low / 1.1, high * 1.1, kLeft, kWidth - kRight, true};
  const Scale y{0.5, static_cast<double>(most) * 1.5, kHeight - kBottom, kTop, true};
  std::string svg = Axes(x, y, x_label, "count");
  for (const TimingHistogram::Range& range : histogram.ranges) {
    const double left = x.At(begin(range)), right = x.At(end(range)),
                 top = y.At(static_cast<double>(range.count));
    svg += fmt::format("<rect class=\"bar\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.1f}\"/>\n",
                       left, top, std::max(0.8, right - left), y.from - top);
  }
  double last_label = -1e9;
  for (const auto& [percent, name] :
       {std::pair{50.0, "p50"}, {99.0, "p99"}, {99.9, "p99.9"}, {100.0, "max"}}) {
    const double value = scale * histogram.Percentile(percent);
    const double at = x.At(std::max(value, low));
    svg += fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", at, kTop, y.from);
    if (at < last_label + 34) continue;
    last_label = at;
    svg += fmt::format("<text class=\"tick\" text-anchor=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                       at > kWidth - 40 ? "end" : "middle", at, kTop - 4, name);
  }
  return Wrap(svg, "histogram of " + x_label);
}

std::string TimeSvg(const std::vector<double>& times_s, const std::vector<TimeLine>& lines,
                    const std::string& y_label) {
  if (times_s.empty()) return "";
  double low = 1e300, high = -1e300;
  for (const TimeLine& line : lines) {
    for (const double value : line.values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(low <= high)) return "";
  const bool logarithmic = low > 0 && high > 30 * low;
  const Scale x{std::min(0.0, times_s.front()), std::max(times_s.back(), 1e-3), kLeft, kWidth - kRight,
                false};
  const Scale y = logarithmic
                      ? Scale{low / 1.3, high * 1.3, kHeight - kBottom, kTop, true}
                      : Scale{std::min(0.0, low), high > 0 ? 1.1 * high : 1, kHeight - kBottom, kTop, false};
  std::string svg = Axes(x, y, "time, s", y_label);
  double key = kWidth - kRight;
  for (size_t i = lines.size(); i-- > 0;) {
    std::string path;
    for (size_t k = 0; k < times_s.size() && k < lines[i].values.size(); ++k) {
      if (!std::isfinite(lines[i].values[k])) continue;
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.At(times_s[k]),
                          y.At(lines[i].values[k]));
    }
    if (times_s.size() == 1) path += "h3";
    svg += fmt::format("<path class=\"line c{}\" d=\"{}\"/>\n", i, path);
    svg += fmt::format("<text class=\"key c{}\" text-anchor=\"end\" x=\"{:.1f}\" y=\"12\">{}</text>\n", i,
                       key, EscapeHtml(lines[i].name));
    key -= 8 + 7 * static_cast<double>(lines[i].name.size());
  }
  return Wrap(svg, y_label + " over time");
}

}  // namespace hydro::timing
