#include "page/svg.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

#include "page/typeset.h"

namespace hydro::page {
namespace {

constexpr double kCell = 3;        // pixels
constexpr int kLabelWeight = 50;   // covering a label is worse than covering a curve
constexpr double kOutside = 1000;  // leaving the frame is worst

}  // namespace

LabelPlacement::LabelPlacement(const Box& frame)
    : frame_(frame),
      columns_(std::max(1, static_cast<int>((frame.right - frame.left) / kCell) + 1)),
      rows_(std::max(1, static_cast<int>((frame.bottom - frame.top) / kCell) + 1)),
      cells_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {}

void LabelPlacement::AddStroke(double x0, double y0, double x1, double y1) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  if (!std::isfinite(length)) return;
  // Follow a line far beyond the frame only for a limited distance.
  const int steps = std::clamp(static_cast<int>(std::min(length / kCell, 2000.0)) + 1, 1, 2000);
  for (int i = 0; i <= steps; ++i) {
    const double column = (x0 + (x1 - x0) * i / steps - frame_.left) / kCell;
    const double row = (y0 + (y1 - y0) * i / steps - frame_.top) / kCell;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
    cells_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)] = 1;
  }
}

double LabelPlacement::Cost(const Box& box) const {
  double cost = 0;
  if (box.left < frame_.left || box.right > frame_.right || box.top < frame_.top ||
      box.bottom > frame_.bottom) {
    cost += kOutside;
  }
  const auto index = [](double pixels, double origin, int count) {
    return std::clamp(static_cast<int>(std::clamp((pixels - origin) / kCell, -1e6, 1e6)), 0, count - 1);
  };
  for (int row = index(box.top, frame_.top, rows_); row <= index(box.bottom, frame_.top, rows_); ++row) {
    for (int column = index(box.left, frame_.left, columns_);
         column <= index(box.right, frame_.left, columns_); ++column) {
      cost += cells_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)];
    }
  }
  return cost;
}

Box LabelPlacement::Place(const std::vector<Box>& candidates) {
  const Box best = *std::min_element(candidates.begin(), candidates.end(),
                                     [this](const Box& a, const Box& b) { return Cost(a) < Cost(b); });
  for (double y = best.top; y <= best.bottom; y += kCell) {
    for (double x = best.left; x <= best.right; x += kCell) {
      const double column = (x - frame_.left) / kCell;
      const double row = (y - frame_.top) / kCell;
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      cells_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)] =
          kLabelWeight;
    }
  }
  return best;
}

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

std::string FillDrawing(std::string_view drawing, const std::map<std::string, std::string>& texts) {
  std::string out;
  std::set<std::string> filled;
  for (size_t begin = 0; begin < drawing.size();) {
    const size_t open = drawing.find("{{", begin);
    const size_t close = drawing.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos) {
      out += drawing.substr(begin);
      break;
    }
    const std::string place(drawing.substr(open + 2, close - open - 2));
    const auto text = texts.find(place);
    if (text == texts.end())
      throw std::logic_error("the drawing has a placeholder '" + place + "' without a text");
    filled.insert(place);
    out += drawing.substr(begin, open - begin);
    out += EscapeMarkup(text->second);
    begin = close + 2;
  }
  for (const auto& [place, text] : texts) {
    if (!filled.contains(place)) throw std::logic_error("the drawing has no placeholder '" + place + "'");
  }
  return out;
}

}  // namespace hydro::page
