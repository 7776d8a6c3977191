#include "bus/udpm/udpm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <string_view>

#include "base/input_error.h"
#include "bus/bus.h"

namespace hydro::bus {
namespace {

constexpr std::string_view kScheme = "udpm://";

[[noreturn]] void Refuse(const std::string& text, const std::string& what) {
  std::string line = "bus url \"" + text + "\": " + what + "; an example is udpm://239.255.76.67:7667?ttl=0";
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';  // stays on one line whatever the text holds
  }
  throw InputError(line);
}

int ParseNumber(const std::string& text, std::string_view number, int lowest, int highest,
                const std::string& name) {
  int value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || value < lowest || value > highest) {
    Refuse(text, name + " is \"" + std::string(number) + "\" and must be a whole number from " +
                     std::to_string(lowest) + " to " + std::to_string(highest));
  }
  return value;
}

void ParseOption(const std::string& text, std::string_view option, UdpmUrl* url) {
  const size_t equals = option.find('=');
  const std::string_view key = option.substr(0, equals);
  const std::string_view value = equals == option.npos ? std::string_view() : option.substr(equals + 1);
  if (key == "ttl") {
    url->ttl = ParseNumber(text, value, 0, 255, "ttl");
  } else if (key == "recv_buf_size") {
    url->recv_buf_size = ParseNumber(text, value, 1, 1 << 30, "recv_buf_size");
  } else {
    Refuse(text, "unknown option \"" + std::string(key) + "\" (known: ttl, recv_buf_size)");
  }
}

}  // namespace

std::string UdpmUrl::ToString() const {
  std::string text = "udpm://" + group + ":" + std::to_string(port) + "?ttl=" + std::to_string(ttl);
  if (recv_buf_size > 0) text += "&recv_buf_size=" + std::to_string(recv_buf_size);
  return text;
}

UdpmUrl ParseUdpmUrl(const std::string& text) {
  if (!text.starts_with(kScheme)) Refuse(text, "must begin with udpm://");
  std::string_view rest = std::string_view(text).substr(kScheme.size());
  std::string_view options;
  if (const size_t question = rest.find('?'); question != rest.npos) {
    options = rest.substr(question + 1);
    rest = rest.substr(0, question);
  }

  UdpmUrl url;
  const size_t colon = rest.find(':');
  if (const std::string_view group = rest.substr(0, colon); !group.empty()) url.group = group;
  in_addr address{};
  if (inet_pton(AF_INET, url.group.c_str(), &address) != 1 || !IN_MULTICAST(ntohl(address.s_addr))) {
    Refuse(text, "\"" + url.group + "\" is not an IPv4 multicast address (224.0.0.0 to 239.255.255.255)");
  }
  if (colon != rest.npos) {
    url.port = static_cast<uint16_t>(ParseNumber(text, rest.substr(colon + 1), 1, 65535, "the port"));
  }
  while (!options.empty()) {
    const size_t ampersand = options.find('&');
    ParseOption(text, options.substr(0, ampersand), &url);
    options = ampersand == options.npos ? std::string_view() : options.substr(ampersand + 1);
  }
  return url;
}

ReservedPort::ReservedPort() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  // So that a port on which another process listens to any group does not count as free.
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  const int yes = 1, no = 0;  // it receives nothing itself
  if (socket_.number() < 0 || bind(socket_.number(), generic, size) != 0 ||
      getsockname(socket_.number(), generic, &size) != 0 ||
      setsockopt(socket_.number(), IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no) != 0 ||
      setsockopt(socket_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0) {
    throw BusError("no free UDP port on this machine");
  }
  number_ = ntohs(address.sin_port);
}

std::string ReservedPort::Url() const { return "udpm://239.255.76.67:" + std::to_string(number_) + "?ttl=0"; }

}  // namespace hydro::bus
