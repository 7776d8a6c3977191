// Ensures that only one launch at a time starts a role of a stack on this machine, even when the bus cannot
// tell: when two start in the same instant, when one's processes are stopped, or when one has another key.
#pragma once

#include <string>
#include <vector>

#include "launch/logic/plan.h"
#include "settings/stack_config.h"

namespace hydro::launch {

class LaunchLock {
 public:
  // Takes the roles of the children of `plan`, on the configuration's port and on the channels of the stack
  // or of their joints, until this object or its process ends. Throws InputError when another launch has one
  // of the roles. A spread stack's logger is not locked: each part may have one.
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
