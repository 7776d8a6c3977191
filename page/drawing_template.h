// A drawing template: an .svg file with placeholders such as {{k_1}}.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace hydro::page {

// Returns the drawing with each placeholder replaced by its text, escaped. Throws std::logic_error naming a
// placeholder without a text, or a text without a placeholder.
std::string FillDrawing(std::string_view drawing, const std::map<std::string, std::string>& texts);

}  // namespace hydro::page
