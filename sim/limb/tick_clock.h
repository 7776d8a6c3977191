// A clock that stands still within a tick. All joints of a limb get the same reading, and only one reading of
// the real clock is needed.
#pragma once

#include "bus/clock.h"

namespace hydro::limb {

class TickClock : public bus::Clock {
 public:
  // `real` must outlive this object. The clock runs until it is stopped.
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
