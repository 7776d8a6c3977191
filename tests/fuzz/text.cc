// Text from outside: whatever its bytes are, what programs show and write of it is UTF-8, and JSON can be
// read.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "base/json_text.h"
#include "base/text_file.h"
#include "base/utf8.h"
#include "launch/logic/run_summary.h"
#include "page/typeset.h"
#include "runs/exports/mat_layout.h"
#include "scope/wire/web_server.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace hydro::fuzz {
namespace {

void JsonOf(const std::string& text) {
  const std::string lines = JsonText(nlohmann::ordered_json{{"text", text}, {text, {text, 1}}}, 1);
  Promise(IsUtf8(lines) && nlohmann::json::accept(lines), "JSON is JSON");
  if (IsUtf8(text)) Promise(nlohmann::json::parse(lines)["text"] == text, "JSON says what it was given");
  const std::string error = scope::ErrorResponse(400, text).body;
  Promise(IsUtf8(error) && nlohmann::json::accept(error), "an error is JSON");
}

// What the launcher says at the end of a fault that somebody has sent.
void SummaryOf(const std::string& text) {
  launch::RunSummary summary;
  fault_t fault{};
  fault.session = 1;
  fault.source = fault.code = fault.text = text;
  fault.active = 1;
  summary.Add(fault);
  const auto printable = [](const std::string& line) { return IsUtf8(Printable(line)); };
  Promise(std::ranges::all_of(summary.Lines(), printable), "a launch says UTF-8");
  Promise(std::ranges::all_of(summary.FaultsLeft(), printable), "a fault is named in UTF-8");
}

}  // namespace

void ForeignText(const uint8_t* data, size_t size) {
  const std::string text(Text(data, size));
  Promise(IsUtf8(text) == (AsUtf8(text) == text), "UTF-8 stays, and nothing else");
  Promise(IsUtf8(AsUtf8(text)), "any bytes become UTF-8");
  Promise(IsUtf8(PrintableLines(text)), "what is printed is UTF-8");
  const std::string line = Printable(text);
  Promise(IsUtf8(line), "what is printed is UTF-8");
  Promise(std::ranges::none_of(line, [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; }),
          "nothing that is printed moves the cursor");
  Promise(Printable(line) == line, "what is printable stays");
  Promise(IsUtf8(page::EscapeMarkup(text)), "a page is UTF-8");
  const std::u16string wide = exports::Utf16(text);
  for (size_t i = 0; i < wide.size(); ++i) {
    const bool high = (wide[i] & 0xfc00) == 0xd800;
    Promise(!high || (i + 1 < wide.size() && (wide[i + 1] & 0xfc00) == 0xdc00), "surrogates come in pairs");
    if (high) ++i;
  }
  for (size_t most = 0; most <= std::min<size_t>(size, 40); ++most) {
    const std::string_view first = FirstBytes(text, most);
    Promise(first.size() <= most && (!IsUtf8(text) || IsUtf8(first)), "a text is cut between characters");
  }
  JsonOf(text);
  SummaryOf(text);
}

}  // namespace hydro::fuzz
