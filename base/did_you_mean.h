// Finds the name that a misspelling probably meant.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// The entry of `names` nearest to `found` in single-character edits, or empty when none is close.
std::string Nearest(const std::string& found, const std::vector<std::string>& names);

// ", did you mean \"x\"?", or empty.
std::string DidYouMean(const std::string& found, const std::vector<std::string>& names);

}  // namespace hydro
