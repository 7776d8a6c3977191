// The table of docs/safety.md, written from process/safety/safety_table.h.
#pragma once

#include <string>

namespace hydro::process {

// The table, in Markdown.
std::string SafetyMarkdown();

// The same for other programs: {"zero_volts_within_ticks": 5, "rows": [{"id": ...}, ...]}.
std::string SafetyJson();

// The page with the table between its two marks. Throws InputError naming `file` when a mark is missing.
std::string WithSafetyTable(const std::string& page, const std::string& file);

}  // namespace hydro::process
