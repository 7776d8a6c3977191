// How the reference comes back after the plant has held the motor at zero volts. The arm may have moved far in that time, and nobody
// expects a jump: the reference starts from where the arm is. Pure.
#pragma once

#include <cstdint>

namespace hydro::position_ctrl {

class ReferenceReturn {
 public:
  // `ticks`: in how many plant ticks the reference goes from where the arm is to where it is wanted; 0: at once.
  explicit ReferenceReturn(int64_t ticks) : ticks_(ticks) {}

  // Once for each state. `driven`: a command is in force that may move the motor. Before the first one, nothing is held:
  // the run begins. `present`: what the reference refers to, as it is measured.
  void Observe(int64_t tick, bool driven, double present) {
    if (!driven || held_ || !begun_) ObserveChange(tick, driven, present);
  }

  // This loop joins a run that has gone on without it: as after a hold.
  void Join() { begun_ = held_ = true; }

  // The reference for the sample at `tick`: `wanted` in normal operation; what was measured last while the motor is
  // held; in between, a straight line from one to the other.
  double Reference(double wanted, int64_t tick);

  // Another reference is followed from `tick` on: it is reached in the same way, from where the one before was.
  void Depart(double from, int64_t tick);

  // Another run begins.
  void Reset() { *this = ReferenceReturn(ticks_); }

 private:
  void ObserveChange(int64_t tick, bool driven, double present);

  int64_t ticks_;
  bool begun_ = false;      // a command has been in force
  bool held_ = false;       // none is any more
  bool returning_ = false;  // one is again
  int64_t returned_ = 0;    // since this tick
  double from_ = 0;
};

}  // namespace hydro::position_ctrl
