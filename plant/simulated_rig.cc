#include "plant/simulated_rig.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <utility>

#include "model/terms/parameter_info.h"

namespace hydro::plant {

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
                      tick, angle, largest_angle_, fmt::arg("unit", units_.UnitFor("rad", 1)))};
}

}  // namespace hydro::plant
