// Changes gains without a jump of the command. At the change the law's output keeps its value, and its
// difference from the new law's output falls linearly to zero. Pure.
#pragma once

#include <cstdint>

namespace hydro::tuning {

class BumplessTransfer {
 public:
  // `ticks` is the number of plant ticks in which the difference falls to zero; 0: at once.
  explicit BumplessTransfer(int64_t ticks) : ticks_(ticks) {}

  // At `tick`, for the same inputs, the law in force gives `before` and the new law gives `after`.
  void Begin(double before, double after, int64_t tick) {
    offset_ = before - after;
    from_ = tick;
    passing_ = ticks_ > 0 && offset_ != 0;
  }

  // The amount to add to the new law's output at `tick`.
  double Offset(int64_t tick) {
    if (!passing_) return 0;
    const double share = static_cast<double>(tick - from_) / static_cast<double>(ticks_);
    if (share >= 1) passing_ = false;
    return passing_ ? (1 - share) * offset_ : 0;
  }

  // Forgets the difference when the voltage is at zero, because there is no output to continue from.
  void Forget() { passing_ = false; }

  bool passing() const { return passing_; }

 private:
  int64_t ticks_;
  double offset_ = 0;
  int64_t from_ = 0;
  bool passing_ = false;
};

}  // namespace hydro::tuning
