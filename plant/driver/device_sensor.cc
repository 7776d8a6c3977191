#include "plant/driver/device_sensor.h"

#include <spdlog/fmt/fmt.h>

#include <utility>

#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

using Source = settings::SensorSection::Source;

std::string Inputs(const DeviceDescription& device, DeviceInput::Kind kind) {
  std::vector<std::string> names;
  for (const DeviceInput& input : device.inputs) {
    if (input.kind == kind) names.push_back(input.name);
  }
  return names.empty() ? "nothing: the device has no such input" : QuotedList(names);
}

size_t IndexOf(const DeviceDescription& device, const std::string& file, const std::string& signal,
               const settings::SensorSection& section) {
  const std::string& name = section.input.empty() ? signal : section.input;
  const auto kind =
      section.source == Source::kCounter ? DeviceInput::Kind::kCount : DeviceInput::Kind::kValue;
  for (size_t i = 0; i < device.inputs.size(); ++i) {
    if (device.inputs[i].name == name && device.inputs[i].kind == kind) return i;
  }
  throw settings::KeyError(file, "driver." + signal + ".input", Quoted(name),
                           Inputs(device, kind) + ", which " + device.name + " has for source = " +
                               (kind == DeviceInput::Kind::kCount ? "\"counter\"" : "\"analog\""));
}

}  // namespace

DeviceSensor::DeviceSensor(const DeviceDescription& device, const settings::StackConfig& config,
                           const std::string& name, const settings::SensorSection& section,
                           const DeviceSensor* angle)
    : name_(name),
      section_(section),
      ends_(CredibleEndsOf(config, name, section)),
      from_device_(section.source == Source::kAnalog || section.source == Source::kCounter),
      angle_(angle),
      patience_(bus::FromSeconds(config.limits.stale_input_s)),
      low_pass_(section.low_pass_hz) {
  if (!from_device_) return;
  index_ = IndexOf(device, config.file, name, section);
  input_ = device.inputs[index_];
  count_ = EncoderCount(input_.highest_count);
}

double DeviceSensor::Take(const DeviceReadings& readings, bus::Clock::TimePoint now) {
  if (section_.source == Source::kNone) return NAN;
  unfiltered_ = Signal(readings, now);
  return low_pass_.Update(unfiltered_, elapsed_s_);
}

void DeviceSensor::Interrupt() {
  unfiltered_ = NAN;
  reading_.value = NAN;
  low_pass_.Update(NAN, 0);
  derivative_.Update(NAN, 0);
}

double DeviceSensor::Signal(const DeviceReadings& readings, bus::Clock::TimePoint now) {
  if (!from_device_) {
    elapsed_s_ = angle_->elapsed_s_;
    const double rate = derivative_.Update(angle_->unfiltered_, elapsed_s_);
    return std::isnan(rate) ? rate : Believed(rate);  // without an angle, the fault is the angle's
  }
  reading_ = readings.inputs[index_];
  elapsed_s_ = read_at_ ? bus::ToSeconds(reading_.at - *read_at_) : 0;
  read_at_ = reading_.at;
  if (now - reading_.at > patience_) {
    return NotCredible(fmt::format("{} has no reading that is newer than {:.4g} s (limits.stale_input_s)",
                                   name_, bus::ToSeconds(patience_)),
                       bus::ToSeconds(now - reading_.at), bus::ToSeconds(patience_));
  }
  if (reading_.at - now > kClockError) {
    return NotCredible(
        fmt::format("{} has a reading from {:.4g} s in the future; allowed is its time on the driver's clock "
                    "(DeviceSettings::clock)",
                    name_, bus::ToSeconds(reading_.at - now)),
        bus::ToSeconds(reading_.at - now), bus::ToSeconds(kClockError));
  }
  if (!std::isfinite(reading_.value)) {
    return NotCredible(fmt::format("{} reads {}, which is no number", name_, reading_.value), reading_.value,
                       NAN);
  }
  return input_.kind == DeviceInput::Kind::kCount ? Counted() : Value();
}

double DeviceSensor::NotCredible(std::string text, double found, double allowed) {
  wrong_ = {"sensor_" + name_, std::move(text), found, allowed};
  Judge(false);
  return NAN;
}

double DeviceSensor::Value() {
  const double value = reading_.value;
  const bool low = std::isnan(section_.minimum) ? value <= input_.low : value < section_.minimum;
  const bool high = std::isnan(section_.maximum) ? value >= input_.high : value > section_.maximum;
  if (low || high) {
    const double limit = low ? section_.minimum : section_.maximum;
    const std::string key = std::string(low ? "minimum" : "maximum") + section_.limit_suffix;
    return NotCredible(
        std::isnan(limit)
            ? fmt::format("{} reads {:.4g} {}, an end of its input range: the input is saturated", name_,
                          value, input_.unit)
            : fmt::format("{} reads {:.4g} {unit}, {} is {:.4g} {unit} (driver.{}.{}); a broken wire?", name_,
                          value, low ? "the least allowed" : "the most allowed", limit, name_, key,
                          fmt::arg("unit", input_.unit)),
        value, std::isnan(limit) ? value : limit);
  }
  return Believed(section_.scale * value + section_.offset);
}

double DeviceSensor::Believed(double signal) {
  if (!ends_.Contain(signal)) {
    return NotCredible(fmt::format("{} is {:.6g} {}, which is not credible: allowed is {}", name_, signal,
                                   ends_.unit, ends_.Allowed(signal)),
                       signal, signal < ends_.low.value ? ends_.low.value : ends_.high.value);
  }
  Judge(true);
  return signal;
}

double DeviceSensor::Counted() {
  const double reading = reading_.value;
  if (reading < 0 || reading > input_.highest_count || reading != std::floor(reading)) {
    return NotCredible(
        fmt::format("{} reads {}, which is no count of 0 to {}", name_, reading, input_.highest_count),
        reading, input_.highest_count);
  }
  const std::optional<int64_t> count = count_.Update(static_cast<uint32_t>(reading));
  if (!count) {
    throw RigError("encoder_lost",
                   fmt::format("driver.{}: the counter has moved by a quarter of its range ({} counts) or "
                               "more since the last reading; the angle is lost",
                               name_, input_.highest_count));
  }
  return Believed(section_.scale * static_cast<double>(*count) + section_.offset);
}

// Several good readings in a row end the fault: a loose contact must not switch the voltage on and off at
// every tick.
void DeviceSensor::Judge(bool good) {
  good_readings_ = good ? good_readings_ + 1 : 0;
  if (!good && !fault_) fault_ = wrong_;
  if (good_readings_ >= kGoodReadings) {
    good_readings_ = kGoodReadings;
    fault_.reset();
  }
}

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
