#include "page/typeset.h"

#include "base/utf8.h"

namespace hydro::page {
namespace {

bool IsWordCharacter(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         static_cast<unsigned char>(c) >= 0x80;
}

enum class Level { kBase, kSubscript, kSuperscript };

struct Span {
  Level level = Level::kBase;
  std::string_view text;
};

// Whether text[at] follows a symbol of one or two letters, rather than part of a name such as command_delay
// or p1_psi.
bool AfterSymbol(std::string_view text, size_t at) {
  int letters = 0;
  for (size_t i = at; i > 0 && IsWordCharacter(text[i - 1]); --i) {
    if (text[i - 1] >= '0' && text[i - 1] <= '9') return false;
    if ((static_cast<unsigned char>(text[i - 1]) & 0xc0) != 0x80) ++letters;  // counts UTF-8 characters
  }
  return letters <= 2;
}

// The text that a '_' or '^' at text[at] lowers or raises, and where the rest begins; empty for an ordinary
// character.
std::string_view Script(std::string_view text, size_t at, size_t* next) {
  if (at == 0 || at + 1 >= text.size()) return {};
  const char before = text[at - 1];
  if (!IsWordCharacter(before) && before != ')' && before != ']' && before != '}' && before != '\'')
    return {};
  if (text[at + 1] == '{') {
    const size_t close = text.find('}', at + 2);
    if (close == std::string_view::npos) return {};
    *next = close + 1;
    return text.substr(at + 2, close - at - 2);
  }
  if (text[at] == '_' && !AfterSymbol(text, at)) return {};
  size_t end = at + 1;
  if (text[at] == '^' && text[end] == '-') ++end;
  const size_t first = end;
  while (end < text.size() && IsWordCharacter(text[end])) ++end;
  if (end == first) return {};
  *next = end;
  return text.substr(at + 1, end - at - 1);
}

std::vector<Span> Spans(std::string_view text) {
  std::vector<Span> spans;
  size_t begin = 0;
  for (size_t i = 0; i < text.size();) {
    size_t next = 0;
    std::string_view script;
    if (text[i] == '_' || text[i] == '^') script = Script(text, i, &next);
    if (script.empty()) {
      ++i;
      continue;
    }
    if (i > begin) spans.push_back({Level::kBase, text.substr(begin, i - begin)});
    spans.push_back({text[i] == '_' ? Level::kSubscript : Level::kSuperscript, script});
    begin = i = next;
  }
  if (begin < text.size()) spans.push_back({Level::kBase, text.substr(begin)});
  return spans;
}

constexpr double kScriptSize = 0.75;

double CharacterWidth(char c) {
  if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) return 0;  // a continuation byte of UTF-8
  if (std::string_view("ijl.,;:'|!").find(c) != std::string_view::npos) return 0.26;
  if (std::string_view("ftr()[]-/ ").find(c) != std::string_view::npos) return 0.32;
  if (std::string_view("mwMW%@").find(c) != std::string_view::npos) return 0.86;
  if (c >= 'A' && c <= 'Z') return 0.69;
  return 0.57;
}

}  // namespace

std::string EscapeMarkup(std::string_view text) {
  std::string out;
  out.reserve(text.size() + 16);
  for (const char c : AsUtf8(text)) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return out;
}

std::string TypesetHtml(std::string_view text) {
  std::string out;
  for (const Span& span : Spans(text)) {
    const std::string escaped = EscapeMarkup(span.text);
    if (span.level == Level::kBase) out += escaped;
    if (span.level == Level::kSubscript) out += "<sub>" + escaped + "</sub>";
    if (span.level == Level::kSuperscript) out += "<sup>" + escaped + "</sup>";
  }
  return out;
}

std::string TypesetSvg(std::string_view text) {
  std::string out;
  const char* back = nullptr;  // shift from a script back to the line, in the text's font size
  for (const Span& span : Spans(text)) {
    const std::string escaped = EscapeMarkup(span.text);
    if (span.level == Level::kBase) {
      out += back == nullptr ? escaped : "<tspan dy=\"" + std::string(back) + "\">" + escaped + "</tspan>";
      back = nullptr;
      continue;
    }
    const bool lower = span.level == Level::kSubscript;
    // A zero-width space carries the shift back when one script follows another.
    if (back != nullptr) out += "<tspan dy=\"" + std::string(back) + "\">&#8203;</tspan>";
    out += std::string("<tspan dy=\"") + (lower ? "0.3em" : "-0.5em") + "\" font-size=\"75%\">" + escaped +
           "</tspan>";
    back = lower ? "-0.225em" : "0.375em";  // the script's em is 75 % of the text's
  }
  return out;
}

double TextWidth(std::string_view text) {
  double width = 0;
  for (const Span& span : Spans(text)) {
    for (const char c : span.text)
      width += CharacterWidth(c) * (span.level == Level::kBase ? 1 : kScriptSize);
  }
  return width;
}

std::vector<std::string> WrapText(std::string_view text, double width) {
  std::vector<std::string> lines;
  for (size_t i = 0; i < text.size();) {
    if (text[i] == ' ' || text[i] == '\n') {
      ++i;
      continue;
    }
    const size_t end = text.find_first_of(" \n", i);
    const std::string word(text.substr(i, end == std::string_view::npos ? end : end - i));
    if (lines.empty() || TextWidth(lines.back() + " " + word) > width) {
      lines.push_back(word);
    } else {
      lines.back() += " " + word;
    }
    i += word.size();
  }
  return lines;
}

}  // namespace hydro::page
