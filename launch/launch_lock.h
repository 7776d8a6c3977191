// One launch at a time starts a role of a stack on this machine, also where the bus cannot tell: two that start in the same instant, one whose
// processes are stopped, one with another key.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::launch {

class LaunchLock {
 public:
  // Takes the roles on the configuration's port and channels, until this object or its process ends. Throws InputError where
  // another launch has one of them. A spread stack's logger is not locked: each part may have one.
  LaunchLock(const settings::StackConfig& config, const std::vector<std::string>& roles, bool spread);
  ~LaunchLock();
  LaunchLock(const LaunchLock&) = delete;
  LaunchLock& operator=(const LaunchLock&) = delete;

 private:
  void Release();

  std::vector<int> sockets_;  // bound to names in Linux's abstract namespace, which leave nothing behind
};

}  // namespace hydro::launch
