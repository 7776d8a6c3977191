#include "page/html_page.h"

#include <spdlog/fmt/fmt.h>

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

}  // namespace hydro::page
