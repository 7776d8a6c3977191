#include "plant/driver/device_sensors.h"

namespace hydro::plant {

DeviceSensors::DeviceSensors(const DeviceDescription& device, const settings::StackConfig& config)
    : p1_(device, config, "p1", config.driver->p1),
      p2_(device, config, "p2", config.driver->p2),
      motor_angle_(device, config, "motor_angle", config.driver->motor_angle),
      motor_speed_(device, config, "motor_speed", config.driver->motor_speed, &motor_angle_),
      arm_angle_(device, config, "arm_angle", config.driver->arm_angle),
      arm_speed_(device, config, "arm_speed", config.driver->arm_speed, &arm_angle_) {}

model::Measurement DeviceSensors::Take(const DeviceReadings& readings, bus::Clock::TimePoint now) {
  model::Measurement measured;
  measured.p1 = p1_.Take(readings, now);
  measured.p2 = p2_.Take(readings, now);
  measured.motor_angle = motor_angle_.Take(readings, now);
  measured.motor_speed = motor_speed_.Take(readings, now);
  measured.arm_angle = arm_angle_.Take(readings, now);
  measured.arm_speed = arm_speed_.Take(readings, now);
  return measured;
}

model::Measurement DeviceSensors::Nothing() {
  for (DeviceSensor* sensor : {&p1_, &p2_, &motor_angle_, &motor_speed_, &arm_angle_, &arm_speed_}) {
    sensor->Interrupt();
  }
  return {.motor_angle = NAN, .motor_speed = NAN, .arm_angle = NAN, .arm_speed = NAN, .p1 = NAN, .p2 = NAN};
}

}  // namespace hydro::plant
