#include "page/heat_map.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/number_text.h"
#include "page/panel_geometry.h"
#include "page/plot.h"
#include "page/svg.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

// Pixels.
constexpr double kMapWidth = 860;
constexpr double kMapHeight = 430;
constexpr double kAbove = 16;
constexpr double kBelow = 52;
constexpr double kScaleWidth = 18;
constexpr double kBeside = 128;  // from the field to the picture's edge: the scale, its numbers and its label
constexpr double kMapFont = 12;
constexpr size_t kMostTexts = 16;  // columns or rows whose names all fit

using Colour = std::array<double, 3>;

Colour ColourAt(double fraction) {
  // Viridis (van der Walt and Smith 2015), at its quarters.
  static constexpr std::array<Colour, 5> kScale = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double place = std::clamp(fraction, 0.0, 1.0) * (kScale.size() - 1);
  const auto below = std::min(static_cast<size_t>(place), kScale.size() - 2);
  Colour colour;
  for (size_t i = 0; i < 3; ++i)
    colour[i] =
        kScale[below][i] + (place - static_cast<double>(below)) * (kScale[below + 1][i] - kScale[below][i]);
  return colour;
}

std::string Hex(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(std::lround(colour[0])),
                     static_cast<int>(std::lround(colour[1])), static_cast<int>(std::lround(colour[2])));
}

std::string Cell(const Box& box, double fraction) {
  // The rectangle is a little wider than the cell, so that no seam shows between cells.
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", Pixels(box.left),
                     Pixels(box.top), Pixels(box.right - box.left + 0.5), Pixels(box.bottom - box.top + 0.5),
                     Hex(ColourAt(fraction)));
}

// Text on a cell, dark on light cells and light on dark ones.
std::string OnCell(const std::string& text, double x, double y, double fraction) {
  const Colour colour = ColourAt(fraction);
  const bool light = 0.299 * colour[0] + 0.587 * colour[1] + 0.114 * colour[2] > 130;
  return fmt::format("<text text-anchor=\"middle\" x=\"{}\" y=\"{}\" style=\"fill: {}\">{}</text>\n",
                     Pixels(x), Pixels(y), light ? "#1a1a1a" : "#ffffff", TypesetSvg(text));
}

class Drawing {
 public:
  explicit Drawing(const HeatMap& map) : map_(map) {
    double widest = 0;
    for (const std::string& name : map.y_names) widest = std::max(widest, kMapFont * TextWidth(name));
    frame_ = {widest + 44, kAbove, kMapWidth - kBeside, kMapHeight - kBelow};
    range_.Include(map.values);
  }

  std::string Draw() const {
    return fmt::format("<svg viewBox=\"0 0 {} {}\">\n{}{}{}{}</svg>", kMapWidth, kMapHeight, Cells(), Names(),
                       Labels(), Scale());
  }

 private:
  double Column(double place) const {
    return frame_.left + place / static_cast<double>(map_.x_names.size()) * (frame_.right - frame_.left);
  }
  double Row(double place) const {
    return frame_.bottom - place / static_cast<double>(map_.y_names.size()) * (frame_.bottom - frame_.top);
  }
  double Fraction(double value) const {
    return range_.high > range_.low ? (value - range_.low) / (range_.high - range_.low) : 0.5;
  }

  std::string Cells() const {
    std::string out;
    const auto columns = map_.x_names.size(), rows = map_.y_names.size();
    const double width = Column(1) - Column(0), height = Row(0) - Row(1);
    for (size_t y = 0; y < rows; ++y) {
      for (size_t x = 0; x < columns; ++x) {
        const double value = map_.values[y * columns + x];
        if (!std::isfinite(value)) continue;
        const auto left = static_cast<double>(x), below = static_cast<double>(y);
        out += Cell({Column(left), Row(below + 1), Column(left + 1), Row(below)}, Fraction(value));
        const std::string text = ShortNumber(value, 3);
        if (kMapFont * TextWidth(text) + 6 < width && height > kMapFont + 4)
          out += OnCell(text, Column(left + 0.5), Row(below + 0.5) + 0.35 * kMapFont, Fraction(value));
      }
    }
    return out + SvgRectangle("frame", frame_);
  }

  // With many columns or rows, only every second, third, ... has its name.
  std::string Names() const {
    std::string out;
    const auto name = [](const std::vector<std::string>& names, size_t i) {
      const size_t every = (names.size() + kMostTexts - 1) / kMostTexts;
      return i % every == 0 ? names[i] : "";
    };
    for (size_t x = 0; x < map_.x_names.size(); ++x) {
      out += SvgText(name(map_.x_names, x), Column(static_cast<double>(x) + 0.5), frame_.bottom + 17,
                     {.anchor = "middle"});
    }
    for (size_t y = 0; y < map_.y_names.size(); ++y) {
      out += SvgText(name(map_.y_names, y), frame_.left - 7, Row(static_cast<double>(y) + 0.5) + 4,
                     {.anchor = "end"});
    }
    return out;
  }

  std::string Labels() const {
    const double middle = (frame_.top + frame_.bottom) / 2;
    return SvgText(map_.x_label, (frame_.left + frame_.right) / 2, frame_.bottom + 39,
                   {.look = "label", .anchor = "middle"}) +
           SvgText(map_.y_label, 18, middle, {.look = "label", .anchor = "middle", .upwards = true}) +
           SvgText(map_.value_label, kMapWidth - 12, middle,
                   {.look = "label", .anchor = "middle", .upwards = true});
  }

  std::string Scale() const {
    const Box box{frame_.right + 24, frame_.top, frame_.right + 24 + kScaleWidth, frame_.bottom};
    constexpr int kParts = 64;
    std::string out;
    const double height = (box.bottom - box.top) / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double bottom = box.bottom - i * height;
      out += Cell({box.left, bottom - height, box.right, bottom}, (i + 0.5) / kParts);
    }
    out += SvgRectangle("frame", box);
    if (!(range_.high > range_.low))
      return out + SvgText(TickNumber(range_.low), box.right + 7, (box.top + box.bottom) / 2 + 4);
    for (const Tick& tick : Ticks({range_.low, range_.high}, box.bottom - box.top, 34)) {
      const double y = box.bottom - Fraction(tick.value) * (box.bottom - box.top);
      out += SvgPath("frame", fmt::format("M{} {}h4", Pixels(box.right), Pixels(y))) +
             SvgText(tick.text, box.right + 7, y + 4);
    }
    return out;
  }

  const HeatMap& map_;
  Box frame_;
  Range range_;
};

}  // namespace

std::string HeatMapDrawing(const HeatMap& map) {
  if (map.values.size() != map.x_names.size() * map.y_names.size())
    throw std::invalid_argument("a heat map of " + std::to_string(map.values.size()) + " values for " +
                                std::to_string(map.x_names.size()) + " x " +
                                std::to_string(map.y_names.size()) + " cells");
  if (std::ranges::none_of(map.values, [](double value) { return std::isfinite(value); }))
    throw std::invalid_argument("a heat map without a value");
  return Drawing(map).Draw();
}

}  // namespace hydro::page
