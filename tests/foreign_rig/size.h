// The size at which something hidden leaves the gap that is asked for.
#pragma once

#include <functional>

#include "gap.h"

namespace foreign_rig {

struct Sized {
  double size = 0;
  GapMeter::Parts parts{0, 0};
  bool reached = false;  // within 15 % of what was asked for
};

// `put` makes a rig of a size; gaps grow with it. `asked` is the gap beyond other values, noise units.
Sized FindSize(const GapMeter& meter, const Rig& plain, double smallest, double largest, double asked,
               const std::function<Rig(double)>& put);

}  // namespace foreign_rig
