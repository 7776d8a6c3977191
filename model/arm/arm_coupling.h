// What the joints of an arm do to each other at one instant, joint by joint: what each joint's actuator needs
// to know of the rest.
#pragma once

#include <vector>

#include "model/arm/planar_arm.h"

namespace hydro::model {

// Of each joint, from the base outwards.
struct JointCoupling {
  explicit JointCoupling(int joints);

  // Given: the motion; the actuator's torque tau with its rate; whether something holds the joint at rest,
  // whatever its load.
  std::vector<double> angle, speed;
  std::vector<double> torque, torque_rate;
  std::vector<bool> held;

  // Found: alpha'' and alpha''' of the whole arm, M alpha'' + bias = tau, where held joints rest.
  std::vector<double> acceleration, jerk;

  // Found: inertia alpha'' = tau + load describes the joint while the others' torques are what they are.
  // inertia = 1/(M^-1)_ii over the joints that are not held and this one; load with its rate is what the
  // others' torques, gravity and motion do to it.
  std::vector<double> inertia;
  std::vector<double> load, load_rate;
};

class ArmCoupling {
 public:
  explicit ArmCoupling(const PlanarArm& arm);

  int joints() const { return arm_.links(); }

  // First, from angle, speed, torque and held: acceleration and inertia.
  void FindAccelerations(JointCoupling* at);
  // Then, from these and torque_rate, for the same instant: the rest.
  void FindLoads(JointCoupling* at);
  // M^-1 torques in place, at this instant; held joints stand alone, with inertia 1.
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
  std::vector<double> held_matrix_;  // M whole, where any joint is held
  std::vector<double> work_;
};

}  // namespace hydro::model
