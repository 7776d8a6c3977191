// The simulated actuator as the plant sees it, through sensors that fail. The observer sees what is really
// driven.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plant/simulated_rig.h"
#include "sim/torture/invariants/observer.h"

namespace hydro::torture {

// The active faults of a plant's sensors. A plant that restarts keeps them.
struct SensorFault {
  FaultKind kind = FaultKind::kSensorNan;
  size_t sensor = 0;
  bool began = false;  // the reading in `held` is the one at which the sensor stuck
  double held = 0;
};

// The next faults of a driver's board. Each occurs once, and a driver that starts finds a board that has been
// repaired.
struct BoardFaults {
  bool refuses_reading = false;
  bool refuses_output = false;
  bool refuses_zero = false;  // from now on
  bool encoder_lost = false;
  bool guardian_gone = false;
};

class FaultyRig : public plant::Rig {
 public:
  // `board` belongs to a driver; null: the process is a plant, which has none.
  FaultyRig(const settings::StackConfig& config, const SimulatedProcess& process,
            std::vector<SensorFault>& faults, BoardFaults* board, Observer& observer);

  std::string role() const override { return board_ == nullptr ? rig_.role() : "driver"; }
  model::Measurement Read(int64_t tick) override;
  const std::vector<plant::RigFault>& faults() const override { return board_faults_; }
  double Drive(double voltage) override;
  plant::OutputLeft Zero() noexcept override;

 private:
  static constexpr size_t kSensorCount = 6;
  void ReadBoard(model::Measurement* measured);

  plant::SimulatedRig rig_;
  const SimulatedProcess& process_;
  std::vector<SensorFault>& faults_;
  BoardFaults* board_;
  Observer& observer_;
  int64_t tick_ = 0;
  double voltage_ = 0;  // that the output now holds
  std::array<int, kSensorCount> good_readings_{};
  std::vector<plant::RigFault> board_faults_;
};

}  // namespace hydro::torture
