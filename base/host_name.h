// The name of the machine on which this process runs.
#pragma once

#include <unistd.h>

#include <string>

namespace hydro {

// The name that `hostname` prints; "unknown" when the system does not tell.
inline std::string HostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

}  // namespace hydro
