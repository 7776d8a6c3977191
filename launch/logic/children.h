// The processes that a launch has started, as it sees them: real ones (launch/supervisor.h) or simulated ones
// (sim/torture/).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "bus/clock.h"
#include "launch/logic/child.h"

namespace hydro::launch {

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
