// Recognises units that are spelled in another way than the programs spell them (units.h).
#pragma once

#include <string>
#include <string_view>

namespace hydro {

// The unit that is meant by a text which is not one, as the programs write it: "N m" for "Nm", "MPa" for
// "mpa", "deg/s" for "°/s". The unit has the same quantity as `wanted`. Empty: none.
std::string UnitMeant(std::string_view text, std::string_view wanted);

// This project's spelling of a unit, if `unit` is another spelling that has no other meaning; otherwise the
// text itself.
std::string_view OurSpelling(std::string_view unit);

}  // namespace hydro
