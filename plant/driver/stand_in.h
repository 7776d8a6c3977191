// driver.simulated_device: a program that stands for a device and that the driver starts and ends.
#pragma once

#include <sys/types.h>

#include <string>

#include "settings/stack_config.h"

namespace hydro::plant {

class StandIn {
 public:
  // If the configuration names a program, starts it in the configuration's folder and waits for its line
  // "ready". Throws InputError when there is no such program, RigError when it does not become ready.
  explicit StandIn(const settings::StackConfig& config);
  ~StandIn() { End(); }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;

 private:
  void End();

  pid_t pid_ = -1;
};

}  // namespace hydro::plant
