// "... at t = 0.25 s, state motor_angle = 0, ...": describes where a simulation stands, for its error
// messages.
#pragma once

#include <sstream>
#include <string>

#include "model/equations/evaluate.h"
#include "model/integrate/point.h"

namespace hydro::model {

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
