// A real actuator behind a data-acquisition board.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "plant/driver/board_sensors.h"
#include "plant/driver/comedi_board.h"
#include "plant/driver/zero_guardian.h"
#include "plant/driver/zero_output.h"
#include "plant/rig.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class BoardRig : public Rig {
 public:
  // Opens the board, checks the channels that [driver] names and writes zero volts. From then on the output
  // goes to zero on every way out of the process (zero_output.h, zero_guardian.h). Throws InputError when the
  // board lacks what the configuration names, RigError when it does not accept the zero.
  BoardRig(const settings::StackConfig& config, const bus::Clock& clock);
  // Writes zero volts, then closes the board.
  ~BoardRig() override;

  std::string role() const override { return "driver"; }
  model::Measurement Read(int64_t tick) override;
  const std::vector<RigFault>& faults() const override { return faults_; }
  // Toggles the watchdog line once the board has accepted the voltage. Throws RigError "guardian_gone",
  // before any voltage is put out, when a kill of this process would leave it.
  double Drive(double voltage) override;
  OutputLeft Zero() noexcept override;

  const std::string& board_name() const { return board_.name(); }
  pid_t guardian() const { return guardian_->pid(); }

 private:
  settings::AmplifierSection amplifier_;
  ComediBoard board_;
  BoardChannel output_;
  std::optional<BoardChannel> watchdog_;
  bool watchdog_high_ = false;
  double min_voltage_;  // V of eq. (1), what limit and range allow
  double max_voltage_;  // V
  ZeroOutput zero_;
  std::optional<ZeroGuardian> guardian_;
  BoardSensors sensors_;
  std::vector<RigFault> faults_;
};

}  // namespace hydro::plant
