#include "base/tables/text_encoding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/number_text.h"
#include "base/utf8.h"

namespace hydro::tables {
namespace {

constexpr uint32_t kNoCharacter = 0xfffd;
constexpr size_t kLookedBytes = 1024;

void AppendUtf8(uint32_t character, std::string& text) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | ((character >> shift) & 0x3f)); };
  if (character < 0x80) {
    text += static_cast<char>(character);
  } else if (character < 0x800) {
    text += static_cast<char>(0xc0 | (character >> 6));
    tail(0);
  } else if (character < 0x10000) {
    text += static_cast<char>(0xe0 | (character >> 12));
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xf0 | (character >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
}

bool IsHighHalf(uint32_t unit) { return unit >= 0xd800 && unit < 0xdc00; }
bool IsLowHalf(uint32_t unit) { return unit >= 0xdc00 && unit < 0xe000; }

}  // namespace

std::string NotUtf8(std::string_view text) {
  for (size_t length = 0; !text.empty(); text.remove_prefix(length)) {
    length = CharacterLength(text);
    if (length > 0) continue;
    return "found byte " + HexNumber(static_cast<unsigned char>(text.front()), 2) +
           ", which is not UTF-8, allowed UTF-8: save the table as UTF-8 (it may be Latin-1 or Windows-1252: "
           "iconv -f "
           "WINDOWS-1252 -t UTF-8)";
  }
  return {};
}

std::optional<std::string> FromUtf16(std::string_view text, const std::string& file) {
  const bool little = text.starts_with("\xff\xfe"), big = text.starts_with("\xfe\xff");
  if (!little && !big) {
    if (text.substr(0, kLookedBytes).find('\0') == std::string_view::npos) return std::nullopt;
    // In UTF-16 without a mark, every other byte is 0. Single zero bytes are left to the reader's errors.
    size_t zeros = 0;
    for (const char c : text.substr(0, kLookedBytes)) zeros += c == '\0';
    if (4 * zeros < text.substr(0, kLookedBytes).size()) return std::nullopt;
    throw InputError(file +
                     ": found a text of zero bytes, UTF-16 without its byte order mark or no text at all, "
                     "allowed UTF-8, or UTF-16 with the mark: save it as UTF-8");
  }
  if (text.size() % 2 != 0) {
    throw InputError(file + ": found half a character at the end of UTF-16, allowed whole ones");
  }
  const auto unit = [&](size_t at) -> uint32_t {
    const auto first = static_cast<unsigned char>(text[at]),
               second = static_cast<unsigned char>(text[at + 1]);
    return static_cast<uint32_t>(little ? first | second << 8 : first << 8 | second);
  };
  std::string utf8;
  utf8.reserve(text.size() / 2);
  for (size_t at = 2; at < text.size(); at += 2) {
    const uint32_t high = unit(at);
    if (!IsHighHalf(high)) {
      AppendUtf8(IsLowHalf(high) ? kNoCharacter : high, utf8);
      continue;
    }
    const uint32_t low = at + 2 < text.size() ? unit(at + 2) : 0;
    AppendUtf8(IsLowHalf(low) ? 0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00) : kNoCharacter, utf8);
    if (IsLowHalf(low)) at += 2;
  }
  return utf8;
}

std::optional<std::string> FromCarriageReturns(std::string_view text) {
  if (text.find('\n') != std::string_view::npos || text.find('\r') == std::string_view::npos)
    return std::nullopt;
  std::string lines(text);
  std::replace(lines.begin(), lines.end(), '\r', '\n');
  return lines;
}

}  // namespace hydro::tables
