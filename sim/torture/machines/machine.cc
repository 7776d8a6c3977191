#include "sim/torture/machines/machine.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hydro::torture {

Machine::Machine(std::string name, const TrueTime* now, double monotonic_s, double utc_s)
    : name_(std::move(name)),
      now_(now),
      local_base_(std::llround(monotonic_s * 1e9)),
      utc_offset_ns_(std::llround((utc_s - monotonic_s) * 1e9)) {}

TrueTime Machine::TrueTimeOf(TimePoint local) const {
  const int64_t left =
      std::chrono::duration_cast<std::chrono::nanoseconds>(local.time_since_epoch()).count() - local_base_;
  if (drift_ == 0 || left <= 0) return true_base_ + left;
  const double rate = 1 + static_cast<double>(drift_) / kBillion;
  // Right apart from rounding.
  auto time = static_cast<TrueTime>(static_cast<double>(left) / rate);
  while (time > 0 && Scaled(time - 1) >= left) --time;
  while (Scaled(time) < left) ++time;
  return true_base_ + time;
}

void Machine::SetDrift(int64_t parts_per_billion) {
  local_base_ = NowNs();
  true_base_ = *now_;
  drift_ = parts_per_billion;
}

void Machine::Slept(int64_t ns) {
  local_base_ -= Scaled(ns);
  suspended_ns_ += ns;
}

}  // namespace hydro::torture
