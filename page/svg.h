// Pieces of SVG. Their look (colours, fonts, light and dark) comes from chart.css, by class.
#pragma once

#include <string>
#include <string_view>

#include "page/label_placement.h"

namespace hydro::page {

// A coordinate as text: "12.3".
std::string Pixels(double value);

struct TextStyle {
  const char* look = "";  // classes of chart.css
  const char* anchor = "start";
  bool upwards = false;  // turned by 90 degrees
};

// A <text> element; `text` is written as page/plot.h describes.
std::string SvgText(std::string_view text, double x, double y, const TextStyle& style = {});

// A <path> with the classes `look` and further attributes.
std::string SvgPath(std::string_view look, std::string_view data, std::string_view attributes = "");

std::string SvgRectangle(std::string_view look, const Box& box);

// Clips `content` to the box.
std::string SvgClipped(const Box& box, std::string_view content);

}  // namespace hydro::page
