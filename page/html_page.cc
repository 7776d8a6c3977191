#include "page/html_page.h"

#include <spdlog/fmt/fmt.h>

#include "base/number_text.h"
#include "page/styles.h"
#include "page/typeset.h"

namespace hydro::page {

std::string_view ChartStyle() { return kChartCss; }

std::string HtmlPage(std::string_view title, std::string_view body, bool wide) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>\n{}{}</style>\n</head>\n<body{}>\n{}</body>\n</html>\n",
      EscapeMarkup(title), kPageCss, kChartCss, wide ? " class=\"wide\"" : "", body);
}

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
