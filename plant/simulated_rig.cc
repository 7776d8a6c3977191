#include "plant/simulated_rig.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "base/random.h"
#include "model/terms/parameter_info.h"

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

double StandardNormal(uint64_t seed, int64_t tick, int channel) {
  return hydro::StandardNormal(Scatter(Scatter(seed) ^ static_cast<uint64_t>(tick)) +
                               static_cast<uint64_t>(channel));
}

bool ReadsExactly(const settings::NoiseSection& noise) {
  return std::max({noise.p1_psi, noise.p1_resolution_psi, noise.p2_psi, noise.p2_resolution_psi,
                   noise.motor_angle_rad, noise.motor_angle_resolution_rad, noise.motor_speed_rad_s,
                   noise.motor_speed_resolution_rad_s, noise.arm_angle_rad, noise.arm_angle_resolution_rad,
                   noise.arm_speed_rad_s, noise.arm_speed_resolution_rad_s}) <= 0;
}

model::Measurement ReadSensors(const model::Measurement& measurement, const settings::NoiseSection& noise,
                               int64_t seed, int64_t tick) {
  model::Measurement reading = measurement;
  int channel = 0;
  const auto read = [&](double& signal, double standard_deviation, double resolution) {
    if (standard_deviation > 0) {
      signal += standard_deviation * StandardNormal(static_cast<uint64_t>(seed), tick, channel);
    }
    if (resolution > 0) signal = std::round(signal / resolution) * resolution;
    ++channel;
  };
  read(reading.p1, noise.p1_psi, noise.p1_resolution_psi);
  read(reading.p2, noise.p2_psi, noise.p2_resolution_psi);
  read(reading.motor_angle, noise.motor_angle_rad, noise.motor_angle_resolution_rad);
  read(reading.motor_speed, noise.motor_speed_rad_s, noise.motor_speed_resolution_rad_s);
  read(reading.arm_angle, noise.arm_angle_rad, noise.arm_angle_resolution_rad);
  read(reading.arm_speed, noise.arm_speed_rad_s, noise.arm_speed_resolution_rad_s);
  return reading;
}

SimulatedRig::SimulatedRig(const settings::StackConfig& config)
    : SimulatedRig(config, MakeActuator(config)) {}

SimulatedRig::SimulatedRig(const settings::StackConfig& config, std::unique_ptr<SimulatedMachine> machine)
    : noise_(config.noise),
      exact_(ReadsExactly(config.noise)),
      seed_(config.seed),
      rate_hz_(config.plant.rate_hz),
      largest_angle_(config.limits.arm_angle_rad),
      units_(config.model.description.units),
      unusual_(model::MostUnusual(config.model.description)),
      machine_(std::move(machine)) {}

model::Measurement SimulatedRig::Read(int64_t tick) {
  const bool late = tick > read_ + 1;
  read_ = tick;
  try {
    if (tick > 0) machine_->Advance(static_cast<double>(tick) / rate_hz_);
    if (exact_) return machine_->Measure();
    return ReadSensors(machine_->Measure(), noise_, seed_, tick);
  } catch (const model::ModelError& error) {
    throw Explained(error, tick, late);
  }
}

RigError SimulatedRig::Explained(const model::ModelError& error, int64_t tick, bool late) const {
  const double angle = machine_->Measure().arm_angle;
  if (!late || !(std::fabs(angle) > largest_angle_)) {
    const std::string cause = unusual_.empty() ? "" : "; the cause may be " + unusual_;
    return {"model_error", fmt::format("{}, before tick {}{}", error.what(), tick, cause)};
  }
  return {"arm_angle_limit",
          fmt::format("before tick {} the arm was at {:.6g} {unit}, allowed is |alpha| <= {:.6g} {unit} "
                      "(limits.arm_angle), and left its cylinder while the plant was late",
                      tick, angle, largest_angle_, fmt::arg("unit", units_.UnitFor("rad", 1))),
          std::fabs(angle), largest_angle_};
}

}  // namespace hydro::plant
