// What a launch starts: each process and the whole plan, and the processes once they are started.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "launch/logic/stop_sequence.h"
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

// Describes what a launch starts, and how patient it is.
struct LaunchPlan {
  std::vector<ChildSpec> children;
  bool spread = false;               // other processes of the stack run on other hosts
  std::vector<std::string> remarks;  // lines that the user should see
  std::string timing_file;           // the .json report on how the loops kept time; empty: none
  std::string stop_command;          // ends whatever stack runs on its bus
};

struct LaunchTiming {
  Grace grace;
  // After a stop was heard: how long the processes may take to end by themselves before they receive SIGTERM.
  bus::Clock::Duration patience = std::chrono::seconds(3);
  // After a process ended with 0 and no stop was heard: how long the stop may take to arrive.
  bus::Clock::Duration stop_arrival = std::chrono::milliseconds(500);
};

// The times that a stop of that plan allows its children.
Grace GraceFor(const LaunchTiming& timing, const LaunchPlan& plan);

// The processes that a launch has started, as it sees them: real ones (launch/supervisor.h) or simulated ones
// (sim/torture/).
class Children {
 public:
  using TimePoint = bus::Clock::TimePoint;

  virtual ~Children() = default;

  // Starts a process and returns its process id. Throws StartError.
  virtual int32_t Start(const ChildSpec& spec) = 0;

  // Waits until a child ends, a signal comes, or `deadline`; returns sooner when there is other work. Takes
  // the steps of a stop that are due. Sends each child a heartbeat, so call it often: without heartbeats a
  // plant goes to zero volts (limits.stale_supervisor_s).
  virtual void Wait(TimePoint deadline) = 0;

  // Return what Wait() has found, oldest first; nothing when there is no more.
  virtual std::optional<Ended> NextEnded() = 0;
  virtual std::optional<int> NextSignal() = 0;

  // Begins the stop (launch/logic/stop_sequence.h). A later call can only bring it forward.
  virtual void Stop(TimePoint first_signal) = 0;
  virtual bool stopping() const = 0;

  // Sends SIGKILL to all children that have not ended.
  virtual void KillAll() = 0;

  virtual int running() const = 0;  // children that have not ended
  // The number of bytes that wait for the reader of this launcher's output.
  virtual size_t unread() const = 0;
  // Whether no child is left and all their output has been passed on.
  bool finished() const { return running() == 0 && unread() == 0; }
};

}  // namespace hydro::launch
