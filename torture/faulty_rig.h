// The simulated actuator as the plant sees it through sensors that fail; the observer sees what is driven.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plant/simulated_rig.h"
#include "torture/invariants/observer.h"

namespace hydro::torture {

// The faults of a plant's sensors while they last; a plant that restarts keeps them.
struct SensorFault {
  FaultKind kind = FaultKind::kSensorNan;
  size_t sensor = 0;
  bool began = false;  // the reading in `held` is the one at which it stuck
  double held = 0;
};

class FaultyRig : public plant::Rig {
 public:
  FaultyRig(const settings::StackConfig& config, const SimulatedProcess& process,
            std::vector<SensorFault>& faults, Observer& observer)
      : rig_(config), process_(process), faults_(faults), observer_(observer) {}

  std::string role() const override { return rig_.role(); }
  model::Measurement Read(int64_t tick) override;
  const std::vector<plant::RigFault>& faults() const override { return rig_.faults(); }
  double Drive(double voltage) override;
  plant::OutputLeft Zero() noexcept override { return rig_.Zero(); }

 private:
  plant::SimulatedRig rig_;
  const SimulatedProcess& process_;
  std::vector<SensorFault>& faults_;
  Observer& observer_;
  int64_t tick_ = 0;
};

}  // namespace hydro::torture
