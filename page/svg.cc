#include "page/svg.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "page/typeset.h"

namespace hydro::page {

std::string Pixels(double value) {
  char text[32];
  const double rounded = std::round(10 * value) / 10;
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, rounded == 0 ? 0.0 : rounded, std::chars_format::fixed);
  return error == std::errc() ? std::string(text, end) : "0";
}

std::string SvgText(std::string_view text, double x, double y, const TextStyle& style) {
  const std::string_view anchor = style.anchor;
  const std::string place =
      style.upwards ? fmt::format("transform=\"translate({} {}) rotate(-90)\"", Pixels(x), Pixels(y))
                    : fmt::format("x=\"{}\" y=\"{}\"", Pixels(x), Pixels(y));
  return fmt::format("<text{}{}{} {}>{}</text>\n", *style.look == '\0' ? "" : " class=\"", style.look,
                     *style.look == '\0' ? "" : "\"",
                     anchor == "start" ? place : fmt::format("text-anchor=\"{}\" {}", anchor, place),
                     TypesetSvg(text));
}

std::string SvgPath(std::string_view look, std::string_view data, std::string_view attributes) {
  return fmt::format("<path class=\"{}\" d=\"{}\"{}/>\n", look, data, attributes);
}

std::string SvgRectangle(std::string_view look, const Box& box) {
  return fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", look,
                     Pixels(box.left), Pixels(box.top), Pixels(std::max(0.0, box.right - box.left)),
                     Pixels(std::max(0.0, box.bottom - box.top)));
}

std::string SvgClipped(const Box& box, std::string_view content) {
  if (content.empty()) return "";
  const std::string left = Pixels(box.left), top = Pixels(box.top), width = Pixels(box.right - box.left),
                    height = Pixels(box.bottom - box.top);
  // A nested <svg> clips what lies outside it, and needs no id.
  return fmt::format(
      "<svg x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\">\n{4}</svg>\n", left,
      top, width, height, content);
}

}  // namespace hydro::page
