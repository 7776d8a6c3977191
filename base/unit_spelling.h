// Units that somebody spells in another way than the programs do (units.h).
#pragma once

#include <string>
#include <string_view>

namespace hydro {

// The unit that a text means which is not one, as the programs write it: "N m" for "Nm", "MPa" for "mpa", "deg/s" for
// "°/s"; a unit of the same quantity as `wanted`. Empty: none.
std::string UnitMeant(std::string_view text, std::string_view wanted);

// The spelling here of a unit that others spell in another way, one that has no other meaning; else the text itself.
std::string_view OurSpelling(std::string_view unit);

}  // namespace hydro
