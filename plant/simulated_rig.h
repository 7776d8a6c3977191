// The simulated actuator with its simulated sensors.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plant/rig.h"
#include "plant/sensor_noise.h"
#include "plant/simulated_machine.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class SimulatedRig : public Rig {
 public:
  // Throws InputError when the configuration and the model contradict each other.
  explicit SimulatedRig(const settings::StackConfig& config);
  // Uses another machine than the actuator alone.
  SimulatedRig(const settings::StackConfig& config, std::unique_ptr<SimulatedMachine> machine);

  std::string role() const override { return "plant"; }
  // Throws RigError when the model cannot go on: "arm_angle_limit" when the arm had already passed its limit,
  // in ticks that a late plant has skipped; otherwise "model_error".
  model::Measurement Read(int64_t tick) override;
  const std::vector<RigFault>& faults() const override { return no_faults_; }
  double Drive(double voltage) override {
    machine_->Hold(voltage);
    return voltage;
  }
  void SetNoise(const settings::NoiseSection& noise) override {
    noise_ = noise;
    exact_ = ReadsExactly(noise);
  }
  bool simulated() const override { return true; }
  OutputLeft Zero() noexcept override { return {.accepted = true, .voltage = Drive(0)}; }

 private:
  [[gnu::cold]] RigError Explained(const model::ModelError& error, int64_t tick, bool late) const;

  settings::NoiseSection noise_;
  bool exact_;  // neither noise nor rounding
  int64_t seed_;
  double rate_hz_;
  double largest_angle_;
  UnitSystem units_;
  std::string unusual_;  // in the model's numbers
  int64_t read_ = -1;    // tick
  std::unique_ptr<SimulatedMachine> machine_;
  std::vector<RigFault> no_faults_;
};

}  // namespace hydro::plant
