#include "page/plot.h"

namespace hydro::page {

Curve Line(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, int colour,
           Stroke stroke) {
  return {.label = label, .x = x, .y = y, .stroke = stroke, .colour = colour};
}

}  // namespace hydro::page
