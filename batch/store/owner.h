// Names for files that belong to a running process. They tell the remains of a killed process from files in
// use, on this host and on others.
#pragma once

#include <string>
#include <vector>

namespace hydro::batch {

// A process on any host: "HOST-BOOT-PID-START".
struct Owner {
  std::string host;  // "node17+4026531836": the host, and the set to which its process numbers belong
  std::string boot;  // identifies the boot of the host, 8 hex digits
  long pid = 0;
  long long started = 0;  // clock ticks after that boot
};

Owner ThisProcess();
std::string OwnerText(const Owner& owner);
// The owner at the beginning of a name; pid 0 for other names.
Owner ParseOwner(const std::string& name);

enum class Life { kRuns, kEnded, kUnknown };  // kUnknown: it is on another host
Life LifeOf(const Owner& owner);

// A name that no other object has, in this or any other process.
std::string NewOwnerName();

// Paths in `folder` whose names begin with `name` and a point.
std::vector<std::string> OwnedBy(const std::string& folder, const std::string& name);

// Paths in `folder` whose owners have ended, and paths of owners on other hosts that have not been touched
// for a day.
std::vector<std::string> LeftBehind(const std::string& folder);

}  // namespace hydro::batch
