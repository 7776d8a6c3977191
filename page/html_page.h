// The frame, the look and the tables of every HTML page that the project writes. Pages are self-contained.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hydro::page {

// A whole document with the style sheets. `title` is plain text, `body` is HTML; `wide` is for tables with
// many columns.
std::string HtmlPage(std::string_view title, std::string_view body, bool wide = false);

// The style sheet of pictures, which SVG files need as well.
std::string_view ChartStyle();

// A cell whose `text` is typeset as page/plot.h describes.
std::string Cell(const std::string& text);
// A cell with a number of four digits.
std::string NumberCell(double value);

// `rows` holds <tr> elements. Columns whose names begin with '#' hold numbers. `style` holds classes of
// page.css.
std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style = "");

}  // namespace hydro::page
