#include "scope/wire/access.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace hydro::scope {
namespace {

bool SameText(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool SameSecret(std::string_view given, std::string_view secret) {
  // Compares every byte of the secret, whatever was given, so that the time depends only on the length of the
  // given text.
  unsigned difference = given.size() == secret.size() ? 0 : 1;
  for (size_t i = 0; i < secret.size(); ++i) {
    const char other = given.empty() ? '\0' : given[i % given.size()];
    difference |= static_cast<unsigned char>(other) ^ static_cast<unsigned char>(secret[i]);
  }
  return difference == 0;
}

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

Access::Access(std::string token, int port, std::vector<std::string> hosts,
               const std::vector<std::string>& origins)
    : token_(std::move(token)), hosts_(std::move(hosts)) {
  for (const char* name : {"127.0.0.1", "localhost", "[::1]"}) {
    hosts_.push_back(std::string(name) + ":" + std::to_string(port));
    if (port == 80) hosts_.emplace_back(name);
  }
  for (const std::string& host : hosts_) {
    origins_.push_back("http://" + host);
    origins_.push_back("https://" + host);
  }
  origins_.insert(origins_.end(), origins.begin(), origins.end());
}

bool Access::HostAllowed(std::string_view host) const {
  return std::any_of(hosts_.begin(), hosts_.end(), [&](const auto& known) { return SameText(known, host); });
}

bool Access::OriginAllowed(std::string_view origin) const {
  return origin.empty() || std::any_of(origins_.begin(), origins_.end(),
                                       [&](const auto& known) { return SameText(known, origin); });
}

bool Access::TokenRight(std::string_view authorization, std::string_view query_token) const {
  constexpr std::string_view kBearer = "Bearer ";
  if (authorization.empty()) return SameSecret(query_token, token_);
  const bool bearer = authorization.starts_with(kBearer);
  return SameSecret(bearer ? authorization.substr(kBearer.size()) : "", token_);
}

std::string FreshToken() {
  std::array<uint8_t, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the kernel gave no random numbers, errno " + std::to_string(errno));
  }
  std::string text;
  for (const uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

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
