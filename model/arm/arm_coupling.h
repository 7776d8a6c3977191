// How the joints of an arm affect each other at one instant: for each joint, what its actuator needs to know
// about the rest of the arm.
#pragma once

#include <span>
#include <vector>

#include "model/arm/planar_arm.h"
#include "model/terms/description.h"

namespace hydro::model {

// One entry for each joint, from the base outwards.
struct JointCoupling {
  explicit JointCoupling(int joints);

  // Given: the motion; the actuator's torque tau with its rate; and whether something holds the joint at rest
  // whatever its load.
  std::vector<double> angle, speed;
  std::vector<double> torque, torque_rate;
  std::vector<bool> held;

  // Found: alpha'' and alpha''' of the whole arm, M alpha'' + bias = tau, where held joints rest.
  std::vector<double> acceleration, jerk;

  // Found: inertia alpha'' = tau + load describes the joint as long as the others' torques stay as they are.
  // inertia = 1/(M^-1)_ii over this joint and those that are not held. The load, given with its rate, is the
  // effect of the others' torques, of gravity and of the motion.
  std::vector<double> inertia;
  std::vector<double> load, load_rate;
};

class ArmCoupling {
 public:
  explicit ArmCoupling(const PlanarArm& arm);

  int joints() const { return arm_.links(); }

  // Step 1: from angle, speed, torque and held, finds acceleration and inertia.
  void FindAccelerations(JointCoupling* at);
  // Step 2: from these and torque_rate, for the same instant, finds everything else.
  void FindLoads(JointCoupling* at);
  // Replaces `torques` by M^-1 torques at this instant. Held joints stand alone, with inertia 1.
  void Accelerate(std::vector<double>* torques) const;

 private:
  void TakeOutHeld(JointCoupling* at);
  void FindHeldInertias(JointCoupling* at);
  void FindHeldLoads(JointCoupling* at);
  void Solve(const JointCoupling& at, const std::vector<double>& torques, std::vector<double>* x) const;

  PlanarArm arm_;
  ArmPose pose_;
  bool any_held_ = false;
  std::vector<double> factors_;      // of M, where held joints stand alone
  std::vector<double> held_matrix_;  // all of M, where any joint is held
  std::vector<double> work_;
};

// What a joint's controller must be told about the rest of the arm: in-lbf, for each joint: the torque that
// the whole arm needs to follow a reference of these angles, speeds and accelerations
// (PlanarArm::JointTorques), less J_a alpha'' + mgl cos(alpha), which the joint's own model already has.
// Divided by k_2 it is a pressure difference, psi, to be added to the pressure command. For one link with its
// own J_a and mgl it is 0.
void CouplingTorques(const PlanarArm& arm, std::span<const Parameters> joints, std::span<const double> angles,
                     std::span<const double> speeds, std::span<const double> accelerations,
                     std::span<double> torques);

// in-lbf-s^2 and in-lbf: the J_a and mgl that a joint's own model would have if they were measured at these
// angles with all other joints at rest: the arm's inertia about the joint, and the gravity torque on it.
void SetOwnLoads(const PlanarArm& arm, std::span<const double> angles, std::span<Parameters> joints);

}  // namespace hydro::model
