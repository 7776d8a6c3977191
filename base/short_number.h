// Numbers as people read them.
#pragma once

#include <string>

namespace hydro {

// With so many significant digits, or all of those before the point: 3.14, 81000, 2.6e-05. "-" when it is not
// finite.
std::string ShortNumber(double value, int digits = 4);

}  // namespace hydro
