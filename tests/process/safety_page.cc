#include "tests/process/safety_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/input_error.h"
#include "base/word_list.h"
#include "process/fault_codes.h"
#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::string_view kBegin = "<!-- safety_page --write writes this -->\n";
constexpr std::string_view kEnd = "<!-- safety_page ends -->\n";

std::string Code(std::string_view text) { return "`" + std::string(text) + "`"; }

std::vector<std::string> Coded(std::string_view list) {
  std::vector<std::string> words;
  for (const std::string_view word : WordsOf(list)) words.push_back(Code(word));
  return words;
}

// "plant (`logger_gone`, a warning)"
std::string Detected(const SafetyRow& row) {
  std::string text(row.detected);
  if (row.codes.empty()) return text;
  const std::vector<std::string_view> codes = WordsOf(row.codes);
  const bool warning = std::all_of(codes.begin(), codes.end(), IsWarning);
  const std::string what = warning ? codes.size() == 1 ? ", a warning" : ", warnings" : "";
  return text + " (" + Joined(Coded(row.codes)) + what + ")";
}

// The tests of a file or a folder together: `fault_loops` `FaultLoopsTest.test_a`, `FaultLoopsTest.test_b`.
std::string Tests(const SafetyRow& row) {
  std::string text, before;
  for (const std::string_view word : WordsOf(row.tests)) {
    const size_t slash = word.rfind('/');
    const bool unit = slash != word.npos;
    const size_t cut = unit ? slash : word.find('.');
    const std::string place = Code((unit ? "tests/" : "") + std::string(word.substr(0, cut)));
    text += text.empty() ? place + " " : place == before ? ", " : "; " + place + " ";
    text += Code(word.substr(cut + 1));
    before = place;
  }
  return text.empty() ? "-" : text;
}

std::string Injected(const SafetyRow& row) {
  return row.injected.empty() ? "not reached: " + std::string(row.not_injected) : Joined(Coded(row.injected));
}

}  // namespace

std::string SafetyMarkdown() {
  std::string text =
      "| fault | detected by | within | output | cleared |\n"
      "|---|---|---|---|---|\n";
  for (const SafetyRow& row : SafetyTable()) {
    text += "| " + std::string(row.fault) + " | " + Detected(row) + " | " + std::string(row.within.text) +
            " | " + std::string(row.output_text) + " | " + std::string(row.cleared_text) + " |\n";
  }
  return text;
}

std::string SafetyTestsMarkdown() {
  std::string text =
      "| fault | tests | in `hydro-torture` |\n"
      "|---|---|---|\n";
  for (const SafetyRow& row : SafetyTable()) {
    text += "| " + std::string(row.fault) + " | " + Tests(row) + " | " + Injected(row) + " |\n";
  }
  return text;
}

std::string SafetyJson() {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SafetyRow& row : SafetyTable()) {
    nlohmann::ordered_json within{{"text", row.within.text}, {"after", row.within.after}};
    if (row.within.ticks) within["ticks"] = *row.within.ticks;
    rows.push_back({{"id", row.id},
                    {"fault", row.fault},
                    {"codes", WordsOf(row.codes)},
                    {"within", within},
                    {"output", NameOf(row.output)},
                    {"cleared", {{"restart", NameOf(row.restart)}, {"explicit", NameOf(row.explicit_rearm)}}},
                    {"tests", WordsOf(row.tests)},
                    {"injected", WordsOf(row.injected)},
                    {"not_injected", row.not_injected}});
  }
  return nlohmann::ordered_json{{"zero_volts_within_ticks", kZeroVoltsWithinTicks}, {"rows", rows}}.dump(1) +
         "\n";
}

std::string WithTable(const std::string& page, const std::string& file, const std::string& table) {
  const size_t begin = page.find(kBegin), end = page.find(kEnd);
  if (begin == page.npos || end == page.npos || end < begin) {
    throw InputError(file + ": found no marks of the table, needed are the lines\n" + std::string(kBegin) +
                     std::string(kEnd));
  }
  return page.substr(0, begin) + std::string(kBegin) + table + page.substr(end);
}

}  // namespace hydro::process
