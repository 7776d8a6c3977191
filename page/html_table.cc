#include "page/html_table.h"

#include "base/number_text.h"
#include "page/typeset.h"

namespace hydro::page {

std::string Cell(const std::string& text) { return "<td>" + TypesetHtml(text) + "</td>"; }

std::string NumberCell(double value) { return "<td class=\"number\">" + ShortNumber(value) + "</td>"; }

std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style) {
  std::string out =
      "<div class=\"table\"><table" + (style.empty() ? "" : " class=\"" + style + "\"") + ">\n<thead><tr>";
  for (const std::string& column : columns) {
    const bool number = column.starts_with('#');
    out += (number ? "<th class=\"number\">" : "<th>") + TypesetHtml(number ? column.substr(1) : column) +
           "</th>";
  }
  return out + "</tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table></div>\n";
}

}  // namespace hydro::page
