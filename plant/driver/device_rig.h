// A rig behind a Device: the rig conditions and judges the readings, limits the output, and puts out zero
// volts on every way out.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "plant/driver/device.h"
#include "plant/driver/device_sensor.h"
#include "plant/driver/device_watch.h"
#include "plant/driver/zero_guardian.h"
#include "plant/rig.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class DeviceRig : public Rig {
 public:
  // Checks that the device has what [driver] names and writes zero volts. From then on the output goes to
  // zero on every way out of the process (zero_guardian.h). Throws InputError when the device lacks what the
  // configuration names, RigError when it does not accept the zero.
  DeviceRig(const settings::StackConfig& config, const bus::Clock& clock, std::unique_ptr<Device> device);
  // Writes zero volts, then closes the device.
  ~DeviceRig() override;

  std::string role() const override { return "driver"; }
  model::Measurement Read(int64_t tick) override;
  const std::vector<RigFault>& faults() const override { return faults_; }
  // Throws RigError "guardian_gone", before any voltage is put out, when a kill of this process would leave
  // that voltage standing.
  double Drive(double voltage) override;
  OutputLeft Zero() noexcept override;

  pid_t guardian() const { return guardian_->pid(); }

 private:
  double Terminal(double voltage) const { return (voltage - amplifier_.offset) / amplifier_.scale; }
  bool WriteZero() noexcept;
  void AwaitReadings();

  settings::AmplifierSection amplifier_;
  const bus::Clock& clock_;
  std::unique_ptr<Device> device_;
  DeviceDescription description_;
  DeviceSensors sensors_;
  DeviceWatch watch_;
  DeviceReadings readings_;
  double min_voltage_;  // V of eq. (1), allowed by limit and range
  double max_voltage_;  // V
  double zero_;         // the output at which the voltage is zero
  bool begun_ = false;
  std::unique_ptr<ZeroGuardian> guardian_;
  std::vector<RigFault> faults_;
};

}  // namespace hydro::plant
