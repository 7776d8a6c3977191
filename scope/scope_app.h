// hydro-scope as a whole: a stack that is listened to, or a log, and the server that shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydro::scope {

struct ScopeRequest {
  std::string input;  // CONFIG, or a log: *.lcmlog, or whatever does not end in .toml
  std::vector<std::string> overrides;
  std::optional<std::string> joint;  // of a limb, the only one that is shown
  std::optional<int> port;           // instead of [scope] port
  std::string page;                  // a folder to serve the page from; empty: from inside the program
};

// Serves until SIGINT, SIGTERM or SIGHUP. Returns the exit code. Throws InputError, and BusError where multicast does not
// work.
int RunScope(const ScopeRequest& request);

}  // namespace hydro::scope
