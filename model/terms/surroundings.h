// What acts on an actuator from outside, and may be measured beside it.
#pragma once

namespace hydro::model {

struct Surroundings {
  // In the direction of alpha, in-lbf; of a linear arm a force: what pushes the arm beside its weight.
  double arm_force = 0;
  double temperature = 20;  // degC, of the oil: a machine that nobody has warmed up

  bool operator==(const Surroundings&) const = default;
};

}  // namespace hydro::model
