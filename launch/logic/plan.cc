#include "launch/logic/plan.h"

namespace hydro::launch {

using namespace std::chrono_literals;

Grace GraceFor(const LaunchTiming& timing, const LaunchPlan& plan) {
  Grace grace = timing.grace;
  // The processes on other hosts may still send messages that belong in the log.
  if (plan.spread && grace.before_last == bus::Clock::Duration::zero()) grace.before_last = 500ms;
  return grace;
}

std::vector<std::string> RolesOf(const LaunchPlan& plan) {
  std::vector<std::string> roles;
  for (const ChildSpec& child : plan.children) roles.push_back(child.role());
  return roles;
}

}  // namespace hydro::launch
