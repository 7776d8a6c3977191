#include "page/drawing_template.h"

#include <set>
#include <stdexcept>

#include "page/typeset.h"

namespace hydro::page {

std::string FillDrawing(std::string_view drawing, const std::map<std::string, std::string>& texts) {
  std::string out;
  std::set<std::string> filled;
  for (size_t begin = 0; begin < drawing.size();) {
    const size_t open = drawing.find("{{", begin);
    const size_t close = drawing.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos) {
      out += drawing.substr(begin);
      break;
    }
    const std::string place(drawing.substr(open + 2, close - open - 2));
    const auto text = texts.find(place);
    if (text == texts.end())
      throw std::logic_error("the drawing has a placeholder '" + place + "' without a text");
    filled.insert(place);
    out += drawing.substr(begin, open - begin);
    out += EscapeMarkup(text->second);
    begin = close + 2;
  }
  for (const auto& [place, text] : texts) {
    if (!filled.contains(place)) throw std::logic_error("the drawing has no placeholder '" + place + "'");
  }
  return out;
}

}  // namespace hydro::page
