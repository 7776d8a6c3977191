#include "diagnose/report/html_parts.h"

#include <cmath>

#include "base/number_text.h"
#include "page/typeset.h"

namespace hydro::diagnose {

std::string Cell(const std::string& text) { return "<td>" + page::TypesetHtml(text) + "</td>"; }

std::string NumberCell(double value) { return "<td class=\"number\">" + ShortNumber(value) + "</td>"; }

std::string ShortCell(double value) { return "<td class=\"number\">" + ShortNumber(value, 2) + "</td>"; }

std::string PercentCell(double part) {
  const std::string text = std::isfinite(part) ? ShortNumber(std::round(100 * part)) + " %" : "-";
  return "<td class=\"number\">" + text + "</td>";
}

std::string IntervalCell(const Estimated& estimated) {
  return "<td class=\"number\">" + ShortNumber(estimated.low) + " to " + ShortNumber(estimated.high) +
         "</td>";
}

std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style) {
  std::string out =
      "<div class=\"table\"><table" + (style.empty() ? "" : " class=\"" + style + "\"") + ">\n<thead><tr>";
  for (const std::string& column : columns) {
    const bool number = column.starts_with('#');
    out += (number ? "<th class=\"number\">" : "<th>") +
           page::TypesetHtml(number ? column.substr(1) : column) + "</th>";
  }
  return out + "</tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table></div>\n";
}

std::string Section(const std::string& heading, const std::string& content) {
  return content.empty() ? "" : "<h2>" + heading + "</h2>\n" + content;
}

std::string Lines(const std::string& text) {
  std::string out, line;
  for (const char c : text) {
    if (c == '\n') {
      out += page::EscapeMarkup(line) + "\n";
      line.clear();
    } else {
      line += c;
    }
  }
  return out + page::EscapeMarkup(line);
}

}  // namespace hydro::diagnose
