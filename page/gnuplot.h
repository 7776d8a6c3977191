// gnuplot as a function from a script to what it draws.
#pragma once

#include <string>

namespace hydro::page {

// Runs gnuplot on `script` without a shell and without the user's settings; what it writes to its standard
// output is returned. Throws std::runtime_error: gnuplot is missing (what to install), or it failed (its
// words).
std::string RunGnuplot(const std::string& script);

}  // namespace hydro::page
