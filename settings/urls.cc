#include "settings/urls.h"

#include <termios.h>

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

struct Baud {
  int rate;
  unsigned constant;
};
constexpr Baud kBauds[] = {{9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
                           {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
                           {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1152000, B1152000},
                           {1500000, B1500000}, {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000},
                           {3500000, B3500000}, {4000000, B4000000}};
constexpr char kAllowed[] = "serial:/dev/NAME?baud=RATE, udp://HOST:PORT or unix:/PATH";
constexpr size_t kLongestSocketPath = 107;  // the longest path that a sockaddr_un holds

std::optional<int> WholeNumber(std::string_view text, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  return whole && value >= 1 && value <= most ? std::optional(value) : std::nullopt;
}

bool TakePrefix(std::string_view* text, std::string_view prefix) {
  if (!text->starts_with(prefix)) return false;
  text->remove_prefix(prefix.size());
  return true;
}

std::string AllowedBauds() {
  std::string list;
  for (const Baud& baud : kBauds) list += (list.empty() ? "" : ", ") + std::to_string(baud.rate);
  return "baud=RATE with one of " + list +
         "; without it the port's speed stays as it is, as USB devices have none";
}

std::string ReadSerial(std::string_view rest, FrontEndUrl* out) {
  const size_t question = rest.find('?');
  out->path = rest.substr(0, question);
  if (out->path.size() < 2 || out->path.front() != '/') {
    return "serial:/dev/NAME with the whole path of the port; ls -l /dev/serial/by-id lists those of USB";
  }
  if (question == std::string_view::npos) return "";
  rest.remove_prefix(question + 1);
  if (!TakePrefix(&rest, "baud=")) return AllowedBauds();
  const std::optional<int> baud = WholeNumber(rest, 1 << 30);
  if (!baud || !BaudConstant(*baud)) return AllowedBauds();
  out->baud = *baud;
  return "";
}

std::string ReadUdp(std::string_view rest, FrontEndUrl* out) {
  constexpr char kAddress[] = "udp://HOST:PORT, e.g. udp://192.168.7.2:7770 or udp://[fe80::1%eth0]:7770";
  const size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return kAddress;
  std::string_view host = rest.substr(0, colon);
  const bool bracketed = host.front() == '[' && host.back() == ']' && host.size() > 2;
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (host.find_first_of("/?[]@ ") != std::string_view::npos) return kAddress;
  if (!bracketed && host.find(':') != std::string_view::npos) return kAddress;
  const std::optional<int> port = WholeNumber(rest.substr(colon + 1), 65535);
  if (!port) return std::string(kAddress) + ", with PORT from 1 to 65535";
  out->host = host;
  out->port = std::to_string(*port);
  return "";
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

std::optional<unsigned> BaudConstant(int baud) {
  for (const Baud& known : kBauds) {
    if (known.rate == baud) return known.constant;
  }
  return std::nullopt;
}

std::string WhatIsWrongWithFrontEndUrl(const std::string& url, FrontEndUrl* out) {
  std::string_view rest = url;
  *out = FrontEndUrl{};
  if (url.find('\0') != std::string::npos) return kAllowed;
  if (TakePrefix(&rest, "serial:")) return ReadSerial(rest, out);
  if (TakePrefix(&rest, "udp://")) {
    out->kind = FrontEndUrl::Kind::kUdp;
    return ReadUdp(rest, out);
  }
  if (!TakePrefix(&rest, "unix:")) return kAllowed;
  out->kind = FrontEndUrl::Kind::kUnix;
  out->path = rest;
  if (rest.size() < 2 || rest.front() != '/' || rest.size() > kLongestSocketPath) {
    return "unix:/PATH with the whole path of the socket, " + std::to_string(kLongestSocketPath) +
           " bytes at most";
  }
  return "";
}

}  // namespace hydro::settings
