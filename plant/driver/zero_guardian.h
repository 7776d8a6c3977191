// A second process that writes the zero when the first can not: after SIGKILL, the out-of-memory killer,
// _exit().
#pragma once

#include <sys/types.h>

#include "plant/driver/zero_output.h"

namespace hydro::plant {

class ZeroGuardian {
 public:
  // Forks a child that shares the open device and sleeps until this process has gone. It then writes
  // `output`, unless Dismiss() was called before, and ends. It does not outlive us by more than that, ignores
  // the signals of the terminal and keeps none of our sockets and files but the device. Throws
  // std::runtime_error when it cannot be started.
  explicit ZeroGuardian(const ZeroOutput& output);
  ~ZeroGuardian() { Dismiss(); }
  ZeroGuardian(const ZeroGuardian&) = delete;
  ZeroGuardian& operator=(const ZeroGuardian&) = delete;

  // The output is at zero and the device is about to be closed: it is not needed any more.
  void Dismiss();

  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  int pipe_ = -1;
};

}  // namespace hydro::plant
