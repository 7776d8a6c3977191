#include "settings/bus_url.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace hydro::settings {
namespace {

bool WholeNumber(std::string_view text, long min, long max) {
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && text.front() != '-' && value >= min &&
         value <= max;
}

// Removes everything up to and including the first `separator` from `rest`, and returns what came before it.
std::string_view Take(std::string_view* rest, char separator) {
  const size_t at = rest->find(separator);
  const std::string_view taken = rest->substr(0, at);
  rest->remove_prefix(at == std::string_view::npos ? rest->size() : at + 1);
  return taken;
}

bool IsMulticastGroup(std::string_view group) {
  if (std::count(group.begin(), group.end(), '.') != 3) return false;
  for (int i = 0; i < 4; ++i) {
    const std::string_view number = Take(&group, '.');
    if (number.size() > 1 && number.front() == '0') return false;  // some programs read it as octal
    if (!WholeNumber(number, i == 0 ? 224 : 0, i == 0 ? 239 : 255)) return false;
  }
  return true;
}

}  // namespace

std::string WhatIsWrongWithBusUrl(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  std::string allowed = "udpm://GROUP:PORT, e.g. udpm://239.255.76.67:7667?ttl=0";
  std::string_view rest = url;
  if (!rest.starts_with(kScheme)) return allowed;
  rest.remove_prefix(kScheme.size());
  const bool has_options = rest.find('?') != std::string_view::npos;
  std::string_view address = Take(&rest, '?');
  if (!IsMulticastGroup(Take(&address, ':')))
    return allowed + " with GROUP from 224.0.0.0 to 239.255.255.255";
  if (!WholeNumber(address, 1, 65535)) return allowed + " with PORT from 1 to 65535";
  if (has_options && rest.empty()) return allowed;
  while (!rest.empty()) {
    std::string_view option = Take(&rest, '&');
    const std::string_view key = Take(&option, '=');
    if (key == "ttl" && WholeNumber(option, 0, 255)) continue;
    if (key == "recv_buf_size" && WholeNumber(option, 1, 1L << 30)) continue;
    return allowed + " with the options ttl=0..255 and recv_buf_size=BYTES";
  }
  return "";
}

}  // namespace hydro::settings
