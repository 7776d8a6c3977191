#include "scope/wire/target.h"

namespace hydro::scope {
namespace {

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> Decoded(std::string_view text, bool plus_is_blank) {
  std::string decoded;
  decoded.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      const int high = i + 2 < text.size() ? HexDigit(text[i + 1]) : -1;
      const int low = high >= 0 ? HexDigit(text[i + 2]) : -1;
      if (low < 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    } else if (c == '+' && plus_is_blank) {
      c = ' ';
    }
    if (c == '\0') return std::nullopt;
    decoded += c;
  }
  return decoded;
}

}  // namespace

std::optional<Target> ParseTarget(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  const size_t mark = target.find('?');
  Target result;
  const auto path = Decoded(target.substr(0, mark), false);
  if (!path) return std::nullopt;
  result.path = *path;
  std::string_view rest = mark == std::string_view::npos ? "" : target.substr(mark + 1);
  while (!rest.empty()) {
    const size_t end = rest.find('&');
    const std::string_view entry = rest.substr(0, end);
    const size_t equals = entry.find('=');
    const auto name = Decoded(entry.substr(0, equals), true);
    const auto value = Decoded(equals == std::string_view::npos ? "" : entry.substr(equals + 1), true);
    if (!name || !value) return std::nullopt;
    result.query.emplace(*name, *value);
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  return result;
}

std::vector<std::string> ListOf(std::string_view header) {
  std::vector<std::string> parts;
  while (!header.empty()) {
    const size_t end = header.find(',');
    std::string_view part = header.substr(0, end);
    while (part.starts_with(' ') || part.starts_with('\t')) part.remove_prefix(1);
    while (part.ends_with(' ') || part.ends_with('\t')) part.remove_suffix(1);
    if (!part.empty()) parts.emplace_back(part);
    header = end == std::string_view::npos ? "" : header.substr(end + 1);
  }
  return parts;
}

}  // namespace hydro::scope
