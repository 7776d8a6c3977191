// The tables of docs/safety.md and docs/developers/safety_tests.md, written from
// process/safety/safety_table.h.
#pragma once

#include <string>

namespace hydro::process {

// What happens at each fault, for users, in Markdown.
std::string SafetyMarkdown();

// Which tests show each fault, for developers, in Markdown.
std::string SafetyTestsMarkdown();

// Both for other programs: {"zero_volts_within_ticks": 5, "rows": [{"id": ...}, ...]}.
std::string SafetyJson();

// The page with `table` between its two marks. Throws InputError naming `file` when a mark is missing.
std::string WithTable(const std::string& page, const std::string& file, const std::string& table);

}  // namespace hydro::process
