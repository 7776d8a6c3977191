#include "launch/logic/children.h"

#include "process/status.h"

namespace hydro::launch {

std::string ChildSpec::program() const {
  if (own) return own->name;
  const std::string& path = argv.at(0);
  return path.substr(path.rfind('/') + 1);  // npos + 1 is 0
}

std::string ChildSpec::role() const { return own ? own->role : process::RoleOf(program()); }

Grace GraceFor(const LaunchTiming& timing, const LaunchPlan& plan) {
  Grace grace = timing.grace;
  // The processes on other hosts may still send messages that belong in the log.
  if (plan.spread && grace.before_last == bus::Clock::Duration::zero())
    grace.before_last = std::chrono::milliseconds(500);
  return grace;
}

}  // namespace hydro::launch
