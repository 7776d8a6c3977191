// The units of the paper in SI, for figures that a person reads (--si).
#pragma once

#include <string>

namespace hydro {

struct SiUnit {
  const char* from;
  const char* to;
  double factor;  // value in `to` = factor * value in `from`
};

// Null where the unit is SI already or not known. `size` decides between kPa and MPa: that of the largest
// value to show.
const SiUnit* FindSiUnit(const std::string& unit, double size);

}  // namespace hydro
