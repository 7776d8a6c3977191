// All measured signals of a rig.
#pragma once

#include <array>

#include "bus/clock.h"
#include "model/actuator.h"
#include "plant/driver/device_sensor.h"

namespace hydro::plant {

class DeviceSensors {
 public:
  // Throws InputError when the device lacks an input.
  DeviceSensors(const DeviceDescription& device, const settings::StackConfig& config);

  // The measurement that these readings give. Throws RigError.
  model::Measurement Take(const DeviceReadings& readings, bus::Clock::TimePoint now);
  // For a silent device: every signal is NaN.
  model::Measurement Nothing();

  std::array<const DeviceSensor*, 6> all() const {
    return {&p1_, &p2_, &motor_angle_, &motor_speed_, &arm_angle_, &arm_speed_};
  }

 private:
  DeviceSensor p1_;
  DeviceSensor p2_;
  DeviceSensor motor_angle_;
  DeviceSensor motor_speed_;
  DeviceSensor arm_angle_;
  DeviceSensor arm_speed_;
};

}  // namespace hydro::plant
