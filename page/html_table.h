// Tables of a page.
#pragma once

#include <string>
#include <vector>

namespace hydro::page {

// A cell whose `text` is typeset as page/plot.h describes.
std::string Cell(const std::string& text);
// A cell with a number of four digits.
std::string NumberCell(double value);

// `rows` holds <tr> elements. Columns whose names begin with '#' hold numbers. `style` holds classes of
// page.css.
std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style = "");

}  // namespace hydro::page
