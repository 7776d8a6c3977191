// Which simple law a closure looks like.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// "grows as the square root of |p2 - p1|", "changes sign with motor_speed (Coulomb friction)", "begins above p1 = 700
// psi", each beside a constant or a straight line where that is needed; "follows no simple law". Of the laws that go
// through the values' bands, the one with the fewest numbers.
std::string Resemblance(const Closure& closure);

}  // namespace hydro::diagnose
