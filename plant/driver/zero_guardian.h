// The one write that must always work, zero volts at the amplifier: while this process can still act, and
// after it.
#pragma once

#include <sys/types.h>

#include <optional>
#include <vector>

#include "plant/driver/device.h"

namespace hydro::plant {

// Has `device` put out `zero`, and tries again when the device refuses. As async-signal-safe as
// Device::Zero(); preserves errno. Returns whether the device took it.
bool WriteZeroTo(Device& device, double zero) noexcept;

// From now on every way out of this process in which it can still act has `device` put out `zero` first:
// exit(), quick_exit(), std::terminate (an uncaught exception) and every signal that ends or stops a process,
// except SIGKILL, SIGSTOP and those that already have a handler. The signal then takes its default action.
// This lasts until DisarmZero(). A process can arm one device; call ArmZero() after CatchStopSignals().
void ArmZero(Device& device, double zero);
void DisarmZero();

// A second process that writes zero volts when the first one cannot: after SIGKILL, the out-of-memory killer
// or _exit().
class ZeroGuardian {
 public:
  // Forks a child that shares the open device and sleeps until this process has gone, whatever children of
  // its own remain. The child then has `device` put out `zero`, unless Dismiss() was called before, and
  // exits. It outlives this process by no more than that. It ignores signals, also those to this process's
  // group, and keeps none of this process's descriptors except `files`. Throws std::runtime_error when the
  // child cannot be started.
  ZeroGuardian(Device& device, const std::vector<int>& files, double zero);
  ~ZeroGuardian() { Dismiss(); }
  ZeroGuardian(const ZeroGuardian&) = delete;
  ZeroGuardian& operator=(const ZeroGuardian&) = delete;

  // Returns false from when the guardian has ended, or stood still (SIGSTOP), and so would not write. The
  // loop calls it in each tick.
  bool Watches();

  // Throws RigError "guardian_gone" from then on.
  void Require();

  // Ends the guardian: the output is at zero and the device is about to be closed.
  void Dismiss() noexcept;

  // Has the guardian write the zero now, and end: for a process whose own descriptors of the device are of no
  // use. Returns whether the device took it. Called again, it says the same.
  bool WriteZero() noexcept;

  pid_t pid() const { return pid_; }

 private:
  std::optional<int> Tell(char word) noexcept;

  pid_t pid_ = -1;
  bool wrote_zero_ = false;
  bool watches_ = true;
  int pipe_ = -1;
};

}  // namespace hydro::plant
