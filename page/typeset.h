// Text of figures and pages: plain text with subscripts and superscripts (page/plot.h), as SVG and as HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hydro::page {

// With <, >, &, " and ' as entities; control characters as blanks.
std::string EscapeMarkup(std::string_view text);

// For the inside of an HTML element: escaped, with <sub> and <sup>.
std::string TypesetHtml(std::string_view text);

// For the inside of an SVG <text> element: escaped, with tspans.
std::string TypesetSvg(std::string_view text);

// The width of the text in units of the font's size: an estimate for Helvetica and its like.
double TextWidth(std::string_view text);

// Breaks it at blanks into lines no wider than `width` (in units of the font's size), where that is possible.
std::vector<std::string> WrapText(std::string_view text, double width);

}  // namespace hydro::page
