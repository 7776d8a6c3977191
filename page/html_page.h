// The frame and the look of every HTML page that the project writes. A page needs nothing but itself.
#pragma once

#include <string>
#include <string_view>

namespace hydro::page {

// A whole document with the style sheets. `title` is plain text, `body` HTML; `wide`: for tables with many columns.
std::string HtmlPage(std::string_view title, std::string_view body, bool wide = false);

// The style sheet of pictures, which an SVG file needs as well.
std::string_view ChartStyle();

}  // namespace hydro::page
