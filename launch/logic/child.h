// Describes a process that a launch starts, and how it ended.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "process/process_end.h"

namespace hydro::launch {

// Further data that a program of the user's own needs (process/own_program.h).
struct OwnChild {
  std::string role;                      // the role that it fills, e.g. position_ctrl
  std::string name;                      // in messages, e.g. "./pid.py (position_ctrl)"
  std::string folder;                    // working folder
  std::vector<std::string> environment;  // "NAME=value", all of it
  int cpu = -1;                          // as in [[process]]; our programs set their own
  int priority = 0;
};

struct ChildSpec {
  std::string label;              // precedes each of its output lines, e.g. plant
  std::vector<std::string> argv;  // argv[0] is the path of the program
  bool last = false;              // is stopped only when all processes without this mark have ended
  std::optional<OwnChild> own = std::nullopt;  // absent: one of our programs
  // For a limb: the joints that it runs, or of which it is a part; otherwise empty.
  std::vector<std::string> joints = {};

  std::string program() const;  // the last part of the path, e.g. hydro-plant; for a user's own, its name
  std::string role() const;     // e.g. pressure_ctrl
};

using process::DescribeEnd;
using process::ProcessEnd;
using process::StartError;

// A child that has ended, as a launch learns of it.
struct Ended {
  std::string label;
  std::string program;
  std::string role;
  int32_t pid = -1;
  ProcessEnd end;
  bool terminated = false;  // the stop sent it SIGTERM
  bool hung = false;        // it did not end on SIGTERM and was sent SIGKILL
};

}  // namespace hydro::launch
