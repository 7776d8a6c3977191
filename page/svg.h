// Pieces of SVG. How they look (colours, fonts, light and dark) is chart.css's, by class.
#pragma once

#include <string>
#include <string_view>

#include "page/label_placement.h"

namespace hydro::page {

// "12.3": a coordinate.
std::string Pixels(double value);

struct TextStyle {
  const char* look = "";  // classes of chart.css
  const char* anchor = "start";
  bool upwards = false;  // turned by 90 degrees
};

// A <text> element; `text` as page/plot.h describes.
std::string SvgText(std::string_view text, double x, double y, const TextStyle& style = {});

// A <path> of the classes `look` with further attributes.
std::string SvgPath(std::string_view look, std::string_view data, std::string_view attributes = "");

std::string SvgRectangle(std::string_view look, const Box& box);

// What `content` draws within the box; the rest is cut off.
std::string SvgClipped(const Box& box, std::string_view content);

}  // namespace hydro::page
