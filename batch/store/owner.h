// Names of files that belong to a running process, so that what a killed one left behind can be told from what is in use, on this host
// and on others.
#pragma once

#include <string>
#include <vector>

namespace hydro::batch {

// A process, on whichever host: "HOST-BOOT-PID-START".
struct Owner {
  std::string host;  // "node17+4026531836": with the set of process numbers that its are of
  std::string boot;  // which boot of the host, 8 hex digits
  long pid = 0;
  long long started = 0;  // clock ticks after that boot
};

Owner ThisProcess();
std::string OwnerText(const Owner& owner);
// The owner at the beginning of a name; pid 0 for other names.
Owner ParseOwner(const std::string& name);

enum class Life { kRuns, kEnded, kUnknown };  // kUnknown: on another host
Life LifeOf(const Owner& owner);

// A name that no other object, in this or another process, has.
std::string NewOwnerName();

// Paths in `folder` whose names begin with `name` and a point.
std::vector<std::string> OwnedBy(const std::string& folder, const std::string& name);

// Paths in `folder` of owners that have ended, and of those on other hosts that have not been touched for a day.
std::vector<std::string> LeftBehind(const std::string& folder);

}  // namespace hydro::batch
