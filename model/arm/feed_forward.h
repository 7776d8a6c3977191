// What a joint's controller must be told about the rest of the arm.
#pragma once

#include <span>

#include "model/arm/planar_arm.h"
#include "model/terms/description.h"

namespace hydro::model {

// in-lbf, for each joint: the torque that the whole arm needs to follow a reference of these angles, speeds
// and accelerations (PlanarArm::JointTorques), less J_a alpha'' + mgl cos(alpha), which the joint's own model
// already has. Divided by k_2 it is a pressure difference, psi, to be added to the pressure command. For one
// link with its own J_a and mgl it is 0.
void CouplingTorques(const PlanarArm& arm, std::span<const Parameters> joints, std::span<const double> angles,
                     std::span<const double> speeds, std::span<const double> accelerations,
                     std::span<double> torques);

// in-lbf-s^2 and in-lbf: the J_a and mgl that a joint's own model would have if they were measured at these
// angles with all other joints at rest: the arm's inertia about the joint, and the gravity torque on it.
void SetOwnLoads(const PlanarArm& arm, std::span<const double> angles, std::span<Parameters> joints);

}  // namespace hydro::model
