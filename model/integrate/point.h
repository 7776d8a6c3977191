// A state together with everything that is known at it.
#pragma once

#include <sstream>
#include <string>

#include "model/equations/evaluate.h"
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

// "... at t = 0.25 s, state motor_angle = 0, ...": describes where a simulation stands, for its error
// messages.
template <class T>
std::string Where(const Equations& equations, const PointOf<T>& at) {
  std::ostringstream out;
  out.precision(10);
  out << " at t = " << at.time << " s, state";
  const auto names = equations.StateNames();
  for (int i = 0; i < equations.states(); ++i)
    out << (i == 0 ? " " : ", ") << names[i] << " = " << ValueOf(at.state[i]);
  return out.str();
}

}  // namespace hydro::model
