// An arm of several links with an actuator in each joint: gravity and inertia couple the joints' loads.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "model/actuator.h"
#include "model/arm/arm_description.h"
#include "model/terms/power.h"

namespace hydro::model {

// What drives one joint. The arm takes the place of the model's J_a and mgl. `options.shaft` is kFree, or
// kClamped for a joint that is locked at options.arm_angle.
struct ArmJoint {
  ModelDescription model;
  // The exchange of loads leaves more than this tolerance does; a finer one costs time and gains nothing.
  ActuatorOptions options = {.relative_tolerance = 1e-5};
};

struct CoupledArmOptions {
  double longest_step = 1e-3;  // s, from one exchange of loads to the next
  // Exchanges per radian of the fastest oscillation that the arm can have on the fluid it compresses. More is
  // more accurate (docs/model.md).
  double steps_per_radian = 2.5;
};

class CoupledArm {
 public:
  // A joint for each link, from the base outwards. All start at rest at time 0, with arm angles
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

  // Joints count from 0. As Actuator::Measure.
  Measurement Measure(int joint) const;

  // in-lbf: what the actuator gives its joint, k_2 dp and what effects make of it; friction of the arm's own
  // included.
  double ActuatorTorque(int joint) const;
  double Acceleration(int joint) const;  // rad/s^2

  // Of one joint's actuator: the arm enters as shaft_in, and in `kinetic` only the motor counts.
  Power PowerBalance(int joint) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
