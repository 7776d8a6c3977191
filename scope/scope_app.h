// hydro-scope as a whole: a stack to which it listens, or a log, and the server that shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydro::scope {

struct ScopeRequest {
  std::string input;  // CONFIG, or a log: *.lcmlog, or any name that does not end in .toml
  std::vector<std::string> overrides;
  std::optional<std::string> joint;  // the joint of a limb that is shown alone
  std::optional<int> port;           // instead of [scope] port
  std::string page;  // the folder from which to serve the page; empty: from inside the program
};

// Serves until SIGINT, SIGTERM or SIGHUP. Returns the exit code. Throws InputError, and BusError when
// multicast does not work.
int RunScope(const ScopeRequest& request);

}  // namespace hydro::scope
