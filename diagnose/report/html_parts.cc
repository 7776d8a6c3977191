#include "diagnose/report/html_parts.h"

#include <cmath>

#include "base/number_text.h"
#include "page/typeset.h"

namespace hydro::diagnose {

std::string ShortCell(double value) { return "<td class=\"number\">" + ShortNumber(value, 2) + "</td>"; }

std::string PercentCell(double part) {
  const std::string text = std::isfinite(part) ? ShortNumber(std::round(100 * part)) + " %" : "-";
  return "<td class=\"number\">" + text + "</td>";
}

std::string IntervalCell(const Estimated& estimated) {
  return "<td class=\"number\">" + ShortNumber(estimated.low) + " to " + ShortNumber(estimated.high) +
         "</td>";
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
