// A change of gains without a jump of the command: at the change the law's output stays what it was, and what it differs by
// from the new law's passes in a straight line to nothing. Pure.
#pragma once

#include <cstdint>

namespace hydro::tuning {

class BumplessTransfer {
 public:
  // `ticks`: in how many plant ticks the difference passes; 0: at once.
  explicit BumplessTransfer(int64_t ticks) : ticks_(ticks) {}

  // At `tick` the law in force gives `before`, and the new one `after`, for the same inputs.
  void Begin(double before, double after, int64_t tick) {
    offset_ = before - after;
    from_ = tick;
    passing_ = ticks_ > 0 && offset_ != 0;
  }

  // To be added to the new law's output at `tick`.
  double Offset(int64_t tick) {
    if (!passing_) return 0;
    const double share = static_cast<double>(tick - from_) / static_cast<double>(ticks_);
    if (share >= 1) passing_ = false;
    return passing_ ? (1 - share) * offset_ : 0;
  }

  // The voltage is at zero: there is nothing to go on from.
  void Forget() { passing_ = false; }

  bool passing() const { return passing_; }

 private:
  int64_t ticks_;
  double offset_ = 0;
  int64_t from_ = 0;
  bool passing_ = false;
};

}  // namespace hydro::tuning
