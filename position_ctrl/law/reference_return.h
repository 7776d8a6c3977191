// Brings the reference back after the plant has held the motor at zero volts. The arm may have moved far in
// that time, and nobody expects a jump: the reference starts at the arm's present angle. Pure.
#pragma once

#include <cstdint>

namespace hydro::position_ctrl {

class ReferenceReturn {
 public:
  // `ticks` is the number of plant ticks in which the reference goes from the arm's angle to the wanted one;
  // 0: at once.
  explicit ReferenceReturn(int64_t ticks) : ticks_(ticks) {}

  // Call it once for each state. `driven` means that a command is in force that may move the motor. Before
  // the first such command nothing is held: the run only begins. `present` is the measured value of the
  // quantity to which the reference refers.
  void Observe(int64_t tick, bool driven, double present) {
    if (!driven || held_ || !begun_) ObserveChange(tick, driven, present);
  }

  // This loop joins a run that has gone on without it; the reference behaves as after a hold.
  void Join() { begun_ = held_ = true; }

  // The reference for the sample at `tick`: `wanted` in normal operation; the last measured value while the
  // motor is held; in between, a straight line from one to the other.
  double Reference(double wanted, int64_t tick);

  // Another reference is followed from `tick` on. It is reached in the same way, starting at `from`, the
  // value of the previous one.
  void Depart(double from, int64_t tick);

  // Begins another run.
  void Reset() { *this = ReferenceReturn(ticks_); }

 private:
  void ObserveChange(int64_t tick, bool driven, double present);

  int64_t ticks_;
  bool begun_ = false;      // a command has been in force
  bool held_ = false;       // no command is in force any more
  bool returning_ = false;  // a command is in force again
  int64_t returned_ = 0;    // since this tick
  double from_ = 0;
};

}  // namespace hydro::position_ctrl
