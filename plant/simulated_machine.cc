#include "plant/simulated_machine.h"

#include "base/input_error.h"

namespace hydro::plant {
namespace {

class ActuatorAlone final : public SimulatedMachine {
 public:
  explicit ActuatorAlone(const settings::StackConfig& config)
      : motion_(config.model.motion ? settings::MakeTrajectory(*config.model.motion) : nullptr),
        actuator_(config.model.description, WithMotion(ActuatorOptionsOf(config))) {}

  void Hold(double voltage) noexcept override { voltage_ = voltage; }
  void Advance(double until) override { actuator_.Advance(voltage_, until); }
  model::Measurement Measure() const override { return actuator_.Measure(); }

 private:
  model::ActuatorOptions WithMotion(model::ActuatorOptions options) const {
    options.motion = motion_.get();
    return options;
  }

  std::unique_ptr<trajectory::Trajectory>
      motion_;  // of a driven shaft; declared first because actuator_ points to it
  model::Actuator actuator_;
  double voltage_ = 0;
};

}  // namespace

model::ActuatorOptions ActuatorOptionsOf(const settings::StackConfig& config) {
  model::ActuatorOptions options;
  options.shaft = config.model.shaft;
  options.arm_angle = config.model.arm_angle_rad;
  options.bypass = config.model.bypass;
  options.initial_pressure = config.model.initial_pressure_psi;
  options.integrator = config.plant.integrator;
  options.relative_tolerance = config.plant.relative_tolerance;
  return options;
}

std::unique_ptr<SimulatedMachine> MakeActuator(const settings::StackConfig& config) {
  try {
    return std::make_unique<ActuatorAlone>(config);
  } catch (const model::ModelError& error) {
    throw InputError(config.file + ": " + error.what());
  }
}

}  // namespace hydro::plant
