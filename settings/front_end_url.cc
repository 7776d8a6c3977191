#include "settings/front_end_url.h"

#include <termios.h>

#include <charconv>
#include <string_view>

namespace hydro::settings {
namespace {

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
