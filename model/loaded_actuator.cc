#include "model/loaded_actuator.h"

#include <algorithm>

#include "model/equations/equations.h"
#include "model/integrate/simulation.h"

namespace hydro::model {

class LoadedActuator::Impl {
 public:
  Impl(const ModelDescription& description, const ActuatorOptions& options)
      : equations(description, options) {
    if (options.shaft == Shaft::kDriven) throw ModelError("a driven shaft has no load");
    if (loaded()) equations.SetLoad(0, {.inertia = description.parameters.J_a});
    simulation =
        MakeSimulation(&equations, options.integrator, options.initial_pressure, options.relative_tolerance);
    simulation->Advance(0, 0);  // so that rates are known before the first voltage
  }

  bool loaded() const { return equations.data().shaft == Shaft::kFree; }
  const Point& now() const { return simulation->now(); }

  Equations equations;
  std::unique_ptr<Simulation> simulation;
};

LoadedActuator::LoadedActuator(const ModelDescription& description, const ActuatorOptions& options)
    : impl_(std::make_unique<Impl>(description, options)) {}
LoadedActuator::~LoadedActuator() = default;
LoadedActuator::LoadedActuator(LoadedActuator&&) noexcept = default;
LoadedActuator& LoadedActuator::operator=(LoadedActuator&&) noexcept = default;

void LoadedActuator::SetLoad(const ArmLoad& load) {
  impl_->equations.SetLoad(time(), load);
  impl_->simulation->NewLoad();
}

void LoadedActuator::MoveArm(double angle, double speed) {
  if (!impl_->loaded()) throw ModelError("a clamped arm cannot be moved");
  impl_->simulation->MoveArm(angle, speed);
}

void LoadedActuator::Advance(double voltage, double until) { impl_->simulation->Advance(voltage, until); }

double LoadedActuator::time() const { return impl_->now().time; }

Measurement LoadedActuator::Measure() const {
  return impl_->equations.Measure(time(), impl_->now().state, impl_->simulation->history());
}

double LoadedActuator::arm_angle() const {
  return impl_->loaded() ? impl_->now().state[kArmAngle] : impl_->equations.data().arm_angle;
}

double LoadedActuator::arm_speed() const { return impl_->loaded() ? impl_->now().state[kArmSpeed] : 0; }

LoadedActuator::Torque LoadedActuator::ArmTorque() {
  const Point& now = impl_->now();
  const Simulation& s = *impl_->simulation;
  const auto found = impl_->equations.FindArmTorque(now.time, s.voltage(), s.mode(), now.state);
  return {.torque = found.torque, .held = found.held};
}

double LoadedActuator::ArmTorqueRate(double arm_acceleration) const {
  const Point& now = impl_->now();
  const Simulation& s = *impl_->simulation;
  double rate[kMaxStates];
  std::copy_n(now.rate, impl_->equations.states(), rate);
  if (impl_->loaded()) rate[kArmSpeed] = arm_acceleration;
  return impl_->equations.ArmTorqueRate(now.time, s.voltage(), s.mode(), now.state, rate);
}

Power LoadedActuator::PowerBalance() const {
  const Point& now = impl_->now();
  const Simulation& s = *impl_->simulation;
  return impl_->equations.PowerBalance(now.time, s.voltage(), s.mode(), now.state);
}

}  // namespace hydro::model
