// An arm of several links with an actuator in each joint: gravity and inertia couple the joints' loads.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "model/actuator.h"
#include "model/arm/arm_description.h"
#include "model/terms/measurement.h"

namespace hydro::model {

// The drive of one joint. The arm replaces the model's J_a and mgl. `options.shaft` is kFree, or kClamped for
// a joint that is locked at options.arm_angle.
struct ArmJoint {
  ModelDescription model;
  // The exchange of loads has a larger error than this tolerance; a finer one takes time and gains nothing.
  ActuatorOptions options = {.relative_tolerance = 1e-5};
};

struct CoupledArmOptions {
  double longest_step = 1e-3;  // s, from one exchange of loads to the next
  // Exchanges per radian of the fastest possible oscillation of the arm on its compressible fluid. More
  // exchanges are more accurate (docs/model.md).
  double steps_per_radian = 2.5;
};

class CoupledArm {
 public:
  // One joint for each link, from the base outwards. All start at rest at time 0, with arm angles
  // `options.arm_angle`. Throws ModelError, which names the link or the joint.
  CoupledArm(const ArmDescription& arm, const std::vector<ArmJoint>& joints,
             const CoupledArmOptions& options = {});
  ~CoupledArm();
  CoupledArm(CoupledArm&&) noexcept;
  CoupledArm& operator=(CoupledArm&&) noexcept;

  // Advances all joints to time `until` (s, not before time()), each with its amplifier's voltage held.
  // Identical calls give identical bits. Throws ModelError, which names the joint.
  void Advance(std::span<const double> voltages, double until);

  double time() const;
  int joints() const;

  // As Actuator::Measure. Joints count from 0.
  Measurement Measure(int joint) const;

  // in-lbf: the actuator's torque on its joint: k_2 dp as changed by effects, including the arm's own
  // friction.
  double ActuatorTorque(int joint) const;
  double Acceleration(int joint) const;  // rad/s^2

  // The balance of one joint's actuator: the arm enters as shaft_in, and `kinetic` includes only the motor.
  Power PowerBalance(int joint) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
