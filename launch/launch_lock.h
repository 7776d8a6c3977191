// One launch at a time starts a role of a stack on this machine, also where the bus cannot tell: two that start in the same instant, one whose
// processes are stopped, one with another key.
#pragma once

#include <string>
#include <vector>

#include "launch/logic/plan.h"
#include "settings/stack_config.h"

namespace hydro::launch {

class LaunchLock {
 public:
  // Takes what the children of `plan` do, on the configuration's port and on the channels of the stack or of their joints, until this
  // object or its process ends. Throws InputError where another launch does one of them. A spread stack's logger is not locked: each
  // part may have one.
  LaunchLock(const settings::StackConfig& config, const LaunchPlan& plan);
  ~LaunchLock();
  LaunchLock(const LaunchLock&) = delete;
  LaunchLock& operator=(const LaunchLock&) = delete;

 private:
  void Take(const std::string& suffix, const std::string& role, const settings::StackConfig& config);
  void Release();

  std::vector<int> sockets_;  // bound to names in Linux's abstract namespace, which leave nothing behind
};

}  // namespace hydro::launch
