// Describes what a launch starts, and how patient it is.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "launch/logic/child.h"
#include "launch/logic/stop_sequence.h"

namespace hydro::launch {

struct LaunchPlan {
  std::vector<ChildSpec> children;
  bool spread = false;               // other processes of the stack run on other hosts
  std::vector<std::string> remarks;  // lines that the user should see
  std::string timing_file;           // the .json report on how the loops kept time; empty: none
};

struct LaunchTiming {
  Grace grace;
  // After a stop was heard: how long the processes may take to end by themselves before they receive SIGTERM.
  bus::Clock::Duration patience = std::chrono::seconds(3);
  // After a process ended with 0 and no stop was heard: how long the stop may take to arrive.
  bus::Clock::Duration stop_arrival = std::chrono::milliseconds(500);
};

// The roles of the plan's children.
std::vector<std::string> RolesOf(const LaunchPlan& plan);

// The times that a stop of that plan allows its children.
Grace GraceFor(const LaunchTiming& timing, const LaunchPlan& plan);

}  // namespace hydro::launch
