// Tables of a page.
#pragma once

#include <string>
#include <vector>

namespace hydro::page {

// `text` is typeset as page/plot.h describes.
std::string Cell(const std::string& text);
// With four digits.
std::string NumberCell(double value);

// `rows`: <tr> elements. Columns whose names begin with '#' hold numbers. `style`: classes of page.css.
std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style = "");

}  // namespace hydro::page
