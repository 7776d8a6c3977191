// A state together with everything that is known at it.
#pragma once

#include "model/terms/mode.h"
#include "model/terms/state.h"

namespace hydro::model {

// T is double, or Jet for a state with derivatives.
template <class T>
struct PointOf {
  double time = 0;  // s
  alignas(16) T state[kMaxStates] = {};
  alignas(16) T rate[kMaxStates] = {};
  T margin[kMaxSwitches] = {};
};
using Point = PointOf<double>;

// The longest step. A longer one could miss a switch that changes and changes back.
inline constexpr double kLongestStep = 1e-2;  // s

// The longest step when states between the steps are read.
inline constexpr double kLongestStepToRead = 2e-3;  // s

}  // namespace hydro::model
