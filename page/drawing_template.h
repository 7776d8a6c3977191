// A drawing whose numbers are filled in: an .svg file with places such as {{k_1}}.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace hydro::page {

// The drawing with the text for each place, escaped. Throws std::logic_error that names a place without a text, or a text
// without a place.
std::string FillDrawing(std::string_view drawing, const std::map<std::string, std::string>& texts);

}  // namespace hydro::page
