// A simulated machine: its name and its clocks, which drift, jump and stop.
#pragma once

#include <cstdint>
#include <string>

#include "bus/clock.h"

namespace hydro::torture {

// True time in ns since the start of the run. The simulator counts in it, and no process ever sees it.
using TrueTime = int64_t;
inline constexpr TrueTime kSecond = 1'000'000'000;

// The clocks that all processes of one machine read.
class Machine : public bus::Clock {
 public:
  // `now` belongs to the simulator and must outlive this object. `monotonic_s` and `utc_s` are the readings
  // of the clocks at true time 0.
  Machine(std::string name, const TrueTime* now, double monotonic_s, double utc_s);

  const std::string& name() const { return name_; }

  int64_t Utime() const override { return (NowNs() + suspended_ns_ + utc_offset_ns_) / 1000; }
  Duration Suspended() const override { return std::chrono::nanoseconds(suspended_ns_); }

  // The first true time at which Now() is at least `local`.
  TrueTime TrueTimeOf(TimePoint local) const;

  // From now on the clocks run fast by that many parts in 1e9.
  void SetDrift(int64_t parts_per_billion);
  // Sets the wall clock forwards or backwards.
  void JumpUtc(int64_t ns) { utc_offset_ns_ += ns; }
  // The machine has slept for the last `ns`, and Now() does not count that time.
  void Slept(int64_t ns);

 private:
  static constexpr int64_t kBillion = 1'000'000'000;

  TimePoint Read() const override { return TimePoint(std::chrono::nanoseconds(NowNs())); }
  int64_t NowNs() const { return local_base_ + Scaled(*now_ - true_base_); }
  int64_t Scaled(int64_t true_ns) const {
    if (drift_ == 0) return true_ns;
    return true_ns + true_ns / kBillion * drift_ + true_ns % kBillion * drift_ / kBillion;
  }

  std::string name_;
  const TrueTime* now_;
  TrueTime true_base_ = 0;  // the time since which the clock has run at this rate
  int64_t local_base_;      // its reading at that time
  int64_t drift_ = 0;       // parts in 1e9
  int64_t utc_offset_ns_;
  int64_t suspended_ns_ = 0;
};

}  // namespace hydro::torture
