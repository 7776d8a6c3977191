// A clock that stands still within a tick: all joints of a limb take the same reading of it, and nobody pays for another.
#pragma once

#include "bus/clock.h"

namespace hydro::limb {

class TickClock : public bus::Clock {
 public:
  // `real` must outlive it. It runs until it is stopped.
  explicit TickClock(const bus::Clock& real) : real_(real) {}

  void Stop() {
    now_ = real_.Now();
    utime_ = real_.Utime();
    suspended_ = real_.Suspended();
    stopped_ = true;
  }
  void Run() { stopped_ = false; }

  int64_t Utime() const override { return stopped_ ? utime_ : real_.Utime(); }
  Duration Suspended() const override { return stopped_ ? suspended_ : real_.Suspended(); }
  bool simulated() const override { return real_.simulated(); }

 private:
  TimePoint Read() const override { return stopped_ ? now_ : real_.Now(); }

  const bus::Clock& real_;
  TimePoint now_{};
  int64_t utime_ = 0;
  Duration suspended_{};
  bool stopped_ = false;
};

}  // namespace hydro::limb
