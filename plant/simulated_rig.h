// The simulated rig: a machine, which is the actuator or its part of something larger, and the sensors that
// read it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "model/actuator.h"
#include "plant/rig.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// What stands for the machine in a simulated rig: the actuator alone, or its part of something larger.
class SimulatedMachine {
 public:
  virtual ~SimulatedMachine() = default;

  // Holds the amplifier's voltage, V, from now on.
  virtual void Hold(double voltage) noexcept = 0;

  // Advances to time `until`, s, under the voltage that is held. Throws ModelError.
  virtual void Advance(double until) = 0;

  virtual model::Measurement Measure() const = 0;
};

// The options that a configuration states for its actuator, except the motion of a driven shaft.
model::ActuatorOptions ActuatorOptionsOf(const settings::StackConfig& config);

// Makes the actuator alone. Throws InputError when the configuration and the model contradict each other.
std::unique_ptr<SimulatedMachine> MakeActuator(const settings::StackConfig& config);

// The simulated sensors add noise and round. The noise depends only on the seed, the tick and the signal, so
// that a tick gets the same noise in lockstep, in real time and in hydro-sim, whichever ticks were skipped
// before it.

// A standard normal number that depends only on (seed, tick, channel), whatever else is drawn.
double StandardNormal(uint64_t seed, int64_t tick, int channel);

// Whether the sensors read exact values, with neither noise nor rounding.
bool ReadsExactly(const settings::NoiseSection& noise);

// `measurement` as the sensors read it at `tick`: with noise, then rounded to a multiple of the resolution.
model::Measurement ReadSensors(const model::Measurement& measurement, const settings::NoiseSection& noise,
                               int64_t seed, int64_t tick);

// The two together.
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
