#include "position_ctrl/law/reference_return.h"

#include <cmath>

namespace hydro::position_ctrl {

void ReferenceReturn::ObserveChange(int64_t tick, bool driven, double present) {
  // Stored at every state, so that a hold between two samples also starts at the arm's present angle.
  const bool hold = held_ || (begun_ && !driven);
  if (hold && std::isfinite(present)) from_ = present;
  if (driven && held_) {
    held_ = false;
    returning_ = ticks_ > 0;
    returned_ = tick;
  } else if (!driven && begun_) {
    held_ = true;
  }
  begun_ = begun_ || driven;
}

void ReferenceReturn::Depart(double from, int64_t tick) {
  if (held_) return;  // after the hold, the reference comes back to the new one
  from_ = from;
  returning_ = ticks_ > 0;
  returned_ = tick;
}

double ReferenceReturn::Reference(double wanted, int64_t tick) {
  if (held_) return from_;
  if (!returning_) return wanted;
  const double share = static_cast<double>(tick - returned_) / static_cast<double>(ticks_);
  if (share >= 1) {
    returning_ = false;
    return wanted;
  }
  return from_ + share * (wanted - from_);
}

}  // namespace hydro::position_ctrl
