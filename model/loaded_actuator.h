// The simulated actuator whose arm is part of something larger: another model moves with it and tells it its
// load.
#pragma once

#include <memory>

#include "model/actuator.h"
#include "model/terms/arm_load.h"
#include "model/terms/power.h"

namespace hydro::model {

// J_a and mgl of the model do not act; the load stands for them. Effects stay where they are:
// actuator.seal_friction is friction of the joint, arm.flexure a spring between the actuator's shaft and the
// joint, whose angle is then the sensor's. With a clamped shaft there is no load: SetLoad and MoveArm throw.
class LoadedActuator {
 public:
  // As Actuator. Its load is J_a of the model until it is set. Throws ModelError, also for a driven shaft.
  LoadedActuator(const ModelDescription& description, const ActuatorOptions& options);
  ~LoadedActuator();
  LoadedActuator(LoadedActuator&&) noexcept;
  LoadedActuator& operator=(LoadedActuator&&) noexcept;

  // The arm's load from time() on. Throws ModelError.
  void SetLoad(const ArmLoad& load);

  // Puts the arm nearby at time(): a correction. The fluid is compressed as if the arm had turned there.
  void MoveArm(double angle, double speed);

  // As those of Actuator.
  void Advance(double voltage, double until);
  double time() const;
  Measurement Measure() const;

  // The state itself, whatever the sensors read.
  double arm_angle() const;
  double arm_speed() const;

  // What the actuator gives the arm, in-lbf: k_2 dp, changed by effects. `held`: friction of the joint holds
  // it at rest, whatever the load; the torque is then the load's, reversed.
  struct Torque {
    double torque = 0;
    bool held = false;
  };
  Torque ArmTorque();

  // d/dt of that torque, in-lbf/s, while the arm accelerates like this.
  double ArmTorqueRate(double arm_acceleration) const;

  // The load enters as shaft_in; in `kinetic` only the motor counts.
  Power PowerBalance() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
