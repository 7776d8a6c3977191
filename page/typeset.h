// Text of figures and pages: plain text with subscripts and superscripts (page/plot.h), as SVG and as HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hydro::page {

// Text with <, >, &, " and ' as entities and control characters as blanks.
std::string EscapeMarkup(std::string_view text);

// Text for the inside of an HTML element: escaped, with <sub> and <sup>.
std::string TypesetHtml(std::string_view text);

// Text for the inside of an SVG <text> element: escaped, with tspans.
std::string TypesetSvg(std::string_view text);

// The text's width in units of the font size: an estimate for Helvetica and similar fonts.
double TextWidth(std::string_view text);

// Breaks the text at blanks into lines no wider than `width` (in units of the font size) where possible.
std::vector<std::string> WrapText(std::string_view text, double width);

}  // namespace hydro::page
