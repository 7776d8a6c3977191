// Arms that several tests move.
#pragma once

#include "model/arm/arm_description.h"

namespace hydro::testing {

// Links that are all different, with offsets between them.
inline model::ArmDescription UnevenArm(int links, double gravity = 386.09) {
  model::ArmDescription arm;
  arm.gravity = gravity;
  for (int i = 0; i < links; ++i) {
    arm.links.push_back({.mass = 0.06 - 0.005 * i,
                         .length = 18.0 + 1.5 * i,
                         .centre = 7.0 + 0.5 * i,
                         .inertia = 1.5 - 0.1 * i,
                         .angle = i % 2 == 0 ? -0.4 : 0.7});
  }
  return arm;
}

}  // namespace hydro::testing
