#include "position_ctrl/reference_return.h"

#include <cmath>

namespace hydro::position_ctrl {

void ReferenceReturn::Observe(int64_t tick, bool in_command) {
  if (in_command && held_) {
    held_ = false;
    returning_ = ticks_ > 0;
    returned_ = tick;
  } else if (!in_command && begun_) {
    held_ = true;
  }
  begun_ = begun_ || in_command;
}

double ReferenceReturn::Reference(double wanted, double present, int64_t tick) {
  if (held_) {
    if (!std::isfinite(present)) return wanted;
    from_ = present;
    return present;
  }
  if (!returning_) return wanted;
  const double share = static_cast<double>(tick - returned_) / static_cast<double>(ticks_);
  if (share >= 1) {
    returning_ = false;
    return wanted;
  }
  return from_ + share * (wanted - from_);
}

}  // namespace hydro::position_ctrl
