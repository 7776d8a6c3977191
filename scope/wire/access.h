// Decides who may talk to the server, by the token, the Host and the Origin of a request.
//
// Any page that a browser on this machine shows can send requests to 127.0.0.1, and a name that an attacker
// owns may resolve to it. So every request must name the server as its host, a page of another origin is
// refused, and all but the page's own files need the token, which only the terminal has shown.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::scope {

class Access {
 public:
  // `hosts` ("name" or "name:port") and `origins` ("https://name") are allowed in addition to those of this
  // machine at `port`.
  Access(std::string token, int port, std::vector<std::string> hosts,
         const std::vector<std::string>& origins);

  // Whether the request names a host by which this server is known, and does not come from a foreign page.
  bool HostAllowed(std::string_view host) const;
  bool OriginAllowed(std::string_view origin) const;  // an absent one is allowed: only browsers send it
  // Whether the header ("Bearer TOKEN") or, without one, the query has the token. The time for the comparison
  // does not depend on where the two differ.
  bool TokenRight(std::string_view authorization, std::string_view query_token) const;

  const std::string& token() const { return token_; }

 private:
  std::string token_;
  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
};

// 32 hexadecimal digits from the kernel's random numbers.
std::string FreshToken();

// The target of a request: its path and query.
struct Target {
  std::string path;
  std::map<std::string, std::string> query;  // the first value of each name
};

// Empty when the text is not a path, or when it has a wrong escape or a zero byte.
std::optional<Target> ParseTarget(std::string_view target);

// Splits "a, b" into its parts.
std::vector<std::string> ListOf(std::string_view header);

}  // namespace hydro::scope
