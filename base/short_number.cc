#include "base/short_number.h"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace hydro {

std::string ShortNumber(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value == 0 ? 0.0 : value);  // no -0
  // It would write 81000 as 8.1e+04.
  const double size = std::abs(value);
  if (size >= 1 && size < 1e7 && std::strchr(text, 'e') != nullptr)
    std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

}  // namespace hydro
