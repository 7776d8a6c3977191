// A valve that opens gradually: from closed at 0 to wide open at 1 of what drives it. Its switch has three positions: 0 closed,
// 1 between, 2 wide open.
#pragma once

#include <algorithm>
#include <cstdint>

#include "model/terms/mode.h"

namespace hydro::model {

template <class T>
T Opening(int position, const T& drive) {
  return position <= 0 ? T(0.0) : (position == 1 ? drive : T(1.0));
}

template <class T>
T OpeningMargin(int position, const T& drive) {
  if (position <= 0) return -drive;
  return position == 1 ? std::min<T>(drive, 1.0 - drive) : T(drive - 1.0);
}

template <class T>
int8_t NextOpening(int position, const T& drive) {
  if (position == 1) return drive < T(0.5) ? 0 : 2;
  // At a start, and where a motion is known at samples only, the drive may be beyond the ramp.
  if (position <= 0) return drive < T(1.0) ? 1 : 2;
  return drive > T(0.0) ? 1 : 0;
}

}  // namespace hydro::model
