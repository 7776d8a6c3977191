// The frame and the look of every HTML page that the project writes. Pages are self-contained.
#pragma once

#include <string>
#include <string_view>

namespace hydro::page {

// A whole document with the style sheets. `title` is plain text, `body` is HTML; `wide` is for tables with
// many columns.
std::string HtmlPage(std::string_view title, std::string_view body, bool wide = false);

// The style sheet of pictures, which SVG files need as well.
std::string_view ChartStyle();

}  // namespace hydro::page
