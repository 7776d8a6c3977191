// The simulated actuator for an arm that is part of something larger: another model moves the arm with it and
// sets its load.
#pragma once

#include <memory>

#include "model/actuator.h"
#include "model/terms/actuator_options.h"
#include "model/terms/measurement.h"

namespace hydro::model {

// The model's J_a and mgl do not act; the load replaces them. Effects stay where they are:
// actuator.seal_friction is friction of the joint, and arm.flexure is a spring between the actuator's shaft
// and the joint, whose angle the sensor then reads. With a clamped shaft there is no load: SetLoad and
// MoveArm throw.
class LoadedActuator {
 public:
  // As Actuator. Until a load is set, the load is the model's J_a. Throws ModelError, also for a driven
  // shaft.
  LoadedActuator(const ModelDescription& description, const ActuatorOptions& options);
  ~LoadedActuator();
  LoadedActuator(LoadedActuator&&) noexcept;
  LoadedActuator& operator=(LoadedActuator&&) noexcept;

  // Sets the arm's load from time() on. Throws ModelError.
  void SetLoad(const ArmLoad& load);

  // Corrects the arm to a nearby position at time(). The fluid is compressed as if the arm had turned there.
  void MoveArm(double angle, double speed);

  // As in Actuator.
  void Advance(double voltage, double until);
  double time() const;
  Measurement Measure() const;

  // The state itself, regardless of what the sensors read.
  double arm_angle() const;
  double arm_speed() const;

  // What the actuator gives the arm, in-lbf: k_2 dp as changed by effects. `held` means that the joint's
  // friction holds it at rest whatever the load; the torque is then the negative of the load's.
  struct Torque {
    double torque = 0;
    bool held = false;
  };
  Torque ArmTorque();

  // d/dt of that torque, in-lbf/s, while the arm has this acceleration.
  double ArmTorqueRate(double arm_acceleration) const;

  // The load enters as shaft_in; `kinetic` includes only the motor.
  Power PowerBalance() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::model
