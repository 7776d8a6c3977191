// Outside influences on an actuator that may be measured beside it.
#pragma once

namespace hydro::model {

struct Surroundings {
  // In the direction of alpha, in-lbf, or a force for a linear arm: what pushes the arm in addition to its
  // weight.
  double arm_force = 0;
  double temperature = 20;  // degC, of the oil: a machine that nobody has warmed up

  bool operator==(const Surroundings&) const = default;
};

}  // namespace hydro::model
