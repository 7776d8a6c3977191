// One measured signal of a rig: its input of the device, its scaling, and whether its readings are credible.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "bus/clock.h"
#include "model/actuator.h"
#include "plant/credible_ends.h"
#include "plant/driver/device.h"
#include "plant/driver/signal_conditioning.h"
#include "plant/rig.h"
#include "settings/driver_section.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class DeviceSensor {
 public:
  // `name` is that of its section, e.g. "p1". `angle`, for source "derivative", is the sensor whose rate this
  // one is; it must outlive this one and be read before it. Throws InputError when the device has no such
  // input.
  DeviceSensor(const DeviceDescription& device, const settings::StackConfig& config, const std::string& name,
               const settings::SensorSection& section, const DeviceSensor* angle = nullptr);

  // The signal that these readings give. Rates and low passes use the time of the reading, so that a late
  // wake-up causes no false speed. NaN: not measured, or not credible (no number, older than
  // limits.stale_input_s, at an end of the input's range, outside what the configuration allows, or beyond
  // what such a signal can be, credible_ends.h). Throws RigError "encoder_lost" when a counter has moved too
  // far to be followed.
  double Take(const DeviceReadings& readings, bus::Clock::TimePoint now);

  // Call it when the device is silent: there is no signal, and filters and rates start again.
  void Interrupt();

  // The fault "sensor_NAME". It lasts from the first reading that is not credible until kGoodReadings good
  // ones have come in a row.
  const std::optional<RigFault>& fault() const { return fault_; }

  // The last reading, for display.
  const std::string& name() const { return name_; }
  const settings::SensorSection& section() const { return section_; }
  const DeviceInput& input() const { return input_; }
  const Reading& reading() const { return reading_; }

 private:
  double Signal(const DeviceReadings& readings, bus::Clock::TimePoint now);
  double Value();
  double Believed(double signal);
  double Counted();
  double NotCredible(std::string text, double found, double allowed);
  void Judge(bool good);

  std::string name_;
  settings::SensorSection section_;
  CredibleEnds ends_;
  bool from_device_;
  const DeviceSensor* angle_;
  bus::Clock::Duration patience_;
  size_t index_ = 0;  // of its input
  DeviceInput input_;
  EncoderCount count_{0};
  Derivative derivative_;
  LowPass low_pass_;
  Reading reading_;
  std::optional<bus::Clock::TimePoint> read_at_;
  double elapsed_s_ = 0;  // s, between the last two readings; for a rate, those of its angle
  double unfiltered_ = NAN;
  RigFault wrong_;  // what is wrong with the last reading
  std::optional<RigFault> fault_;
  int good_readings_ = kGoodReadings;
};

// All measured signals of a rig.
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
