// The name of the machine that this process runs on.
#pragma once

#include <unistd.h>

#include <string>

namespace hydro {

// As `hostname` prints it; "unknown" when the system does not say.
inline std::string HostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

}  // namespace hydro
