#include "plant/simulated_rig.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "base/input_error.h"

namespace hydro::plant {

SimulatedRig::SimulatedRig(const settings::StackConfig& config)
    : noise_(config.noise),
      exact_(ReadsExactly(config.noise)),
      seed_(config.seed),
      rate_hz_(config.plant.rate_hz),
      largest_angle_(config.limits.arm_angle_rad),
      motion_(config.model.motion ? settings::MakeTrajectory(*config.model.motion) : nullptr) {
  model::ActuatorOptions options;
  options.shaft = config.model.shaft;
  options.arm_angle = config.model.arm_angle_rad;
  options.motion = motion_.get();
  options.bypass = config.model.bypass;
  options.initial_pressure = config.model.initial_pressure_psi;
  options.integrator = config.plant.integrator;
  options.relative_tolerance = config.plant.relative_tolerance;
  try {
    actuator_ = std::make_unique<model::Actuator>(config.model.description, options);
  } catch (const model::ModelError& error) {
    throw InputError(config.file + ": " + error.what());
  }
}

model::Measurement SimulatedRig::Read(int64_t tick) {
  const bool late = tick > read_ + 1;
  read_ = tick;
  try {
    if (tick > 0) actuator_->Advance(voltage_, static_cast<double>(tick) / rate_hz_);
    if (exact_) return actuator_->Measure();
    return ReadSensors(actuator_->Measure(), noise_, seed_, tick);
  } catch (const model::ModelError& error) {
    throw Explained(error, tick, late);
  }
}

RigError SimulatedRig::Explained(const model::ModelError& error, int64_t tick, bool late) const {
  const double angle = actuator_->Measure().arm_angle;
  if (!late || !(std::fabs(angle) > largest_angle_)) return {"model_error", error.what()};
  return {"arm_angle_limit",
          fmt::format("before tick {} the arm was at {:.6g} rad, allowed is |alpha| <= {:.6g} rad "
                      "(limits.arm_angle_rad), and left its cylinder while the plant was late",
                      tick, angle, largest_angle_)};
}

}  // namespace hydro::plant
