#include "plant/front_end/front_end_settings.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/number_text.h"
#include "plant/front_end/refusals.h"
#include "settings/toml/section_reader.h"
#include "tune/live/tuned_values.h"

namespace hydro::plant {
namespace {

using settings::KeyError;
using Source = settings::SensorSection::Source;

// The device judges in single precision: a value that is just within a limit here shall not be beyond it
// there.
float RoundedUp(double limit) {
  const auto rounded = static_cast<float>(limit);
  return static_cast<double>(rounded) < limit
             ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
             : rounded;
}

// The voltage that the device reports shall not be beyond the limit that holds here.
float RoundedDown(double limit) {
  const auto rounded = static_cast<float>(limit);
  return static_cast<double>(rounded) > limit ? std::nextafter(rounded, 0.0F) : rounded;
}

// The device computes in single precision. What that cannot hold would be another setting there: none, or no
// limit.
float Single(const settings::StackConfig& config, const std::string& key, double value) {
  using Limits = std::numeric_limits<float>;
  const double size = std::fabs(value);
  if (value == 0 || (size >= double{Limits::min()} && size <= double{Limits::max()}))
    return static_cast<float>(value);
  throw KeyError(config.file, key, ShortestNumber(value),
                 fmt::format("a magnitude of {:.2g} to {:.2g}, which single precision holds: the front end "
                             "computes in it",
                             Limits::min(), Limits::max()));
}

uint8_t KindOf(Source source) {
  switch (source) {
    case Source::kAnalog:
      return HYDRO_SENSOR_ANALOG;
    case Source::kCounter:
      return HYDRO_SENSOR_COUNTER;
    case Source::kDerivative:
      return HYDRO_SENSOR_RATE;
    case Source::kNone:
      break;
  }
  return HYDRO_SENSOR_NONE;
}

void CheckChannel(const settings::StackConfig& config, const std::string& name, int channel, int channels,
                  const char* what) {
  if (channel < channels) return;
  throw KeyError(config.file, "driver." + name + ".channel", std::to_string(channel),
                 channels == 0
                     ? fmt::format("a front end with {}s: this one has none", what)
                     : fmt::format("0 to {}: the front end has {} {}s", channels - 1, channels, what));
}

// The share of a new reading in the filtered one.
float LowPassShare(const settings::StackConfig& config, const std::string& key, double corner_hz,
                   const hydro_identity& identity) {
  if (corner_hz == 0) return 1;
  const double share = -std::expm1(-2 * std::numbers::pi * corner_hz / identity.tick_rate_hz);
  constexpr double kLeastShare = std::numeric_limits<float>::min();
  if (share >= kLeastShare) return static_cast<float>(share);
  throw KeyError(
      config.file, key, ShortestNumber(corner_hz),
      fmt::format("0 for none, or at least {:.2g}, with which a reading counts in single precision",
                  kLeastShare * identity.tick_rate_hz));
}

hydro_sensor_settings SensorSettings(const settings::StackConfig& config, const std::string& name,
                                     const settings::SensorSection& section, const hydro_identity& identity) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  hydro_sensor_settings sensor{};
  sensor.kind = KindOf(section.source);
  if (sensor.kind == HYDRO_SENSOR_ANALOG) {
    CheckChannel(config, name, section.line.channel, identity.analog_inputs, "analog input");
  }
  if (sensor.kind == HYDRO_SENSOR_COUNTER) {
    CheckChannel(config, name, section.line.channel, identity.counters, "counter");
    sensor.counter_bits = static_cast<uint8_t>(section.counter_bits);
  }
  sensor.channel = static_cast<uint8_t>(section.line.channel);
  const std::string key = "driver." + name + ".";
  sensor.scale = Single(config, key + "scale", section.scale);
  sensor.offset = Single(config, key + "offset", section.offset);
  sensor.low_pass_share = LowPassShare(config, key + "low_pass_hz", section.low_pass_hz, identity);
  sensor.minimum_V =
      std::isnan(section.minimum) ? -kInfinity : Single(config, key + "minimum_V", section.minimum);
  sensor.maximum_V =
      std::isnan(section.maximum) ? kInfinity : Single(config, key + "maximum_V", section.maximum);
  return sensor;
}

constexpr int kModes = 3;  // the bits of both modes

void CheckMode(const settings::StackConfig& config, const hydro_identity& identity, int mode) {
  if ((identity.modes & (1 << (mode - 1))) != 0) return;
  throw KeyError(config.file, "driver.mode", mode == HYDRO_REMOTE_IO ? "\"remote_io\"" : "\"loop_on_device\"",
                 (identity.modes & kModes) == 0
                     ? std::string("a front end with a mode of this version; this one names none")
                     : fmt::format("a mode that the front end has: {}",
                                   mode == HYDRO_REMOTE_IO ? "\"loop_on_device\"" : "\"remote_io\""));
}

uint16_t SampleInterval(const settings::StackConfig& config, const hydro_identity& identity) {
  if (identity.tick_rate_hz == 0) {
    throw KeyError(config.file, "driver.url", "a front end of 0 ticks per second, as it says",
                   "one that says how many it takes: give its board's firmware the rate of its timer");
  }
  const double ticks = identity.tick_rate_hz / config.plant.rate_hz;
  const double whole = std::round(ticks);
  if (whole >= 1 && whole <= 65535 && std::fabs(ticks - whole) < 1e-9 * whole)
    return static_cast<uint16_t>(whole);
  throw KeyError(
      config.file, "plant.rate_hz", ShortestNumber(config.plant.rate_hz),
      fmt::format("a rate that divides the front end's {} ticks per second", identity.tick_rate_hz));
}

uint32_t WatchdogTicks(const settings::StackConfig& config, const hydro_identity& identity) {
  const double seconds = config.driver->front_end.watchdog_s.value_or(config.limits.stale_input_s);
  const double ticks = std::floor(seconds * identity.tick_rate_hz + 1e-9);
  if (ticks >= 1 && ticks <= identity.tick_rate_hz) return static_cast<uint32_t>(ticks);
  throw KeyError(config.file, "driver.watchdog_s", ShortestNumber(seconds),
                 fmt::format("{} to 1: from one tick of the front end to a second",
                             ShortestNumber(1.0 / identity.tick_rate_hz)));
}

// The range that the output can reach, V of eq. (1), must contain zero volts.
void CheckOutput(const settings::StackConfig& config, const hydro_identity& identity) {
  if (!(std::isfinite(identity.output_min_V) && std::isfinite(identity.output_max_V) &&
        identity.output_min_V < identity.output_max_V)) {
    throw KeyError(config.file, "driver.url",
                   fmt::format("a front end whose output goes from {:.6g} to {:.6g} V, as it says",
                               identity.output_min_V, identity.output_max_V),
                   "one with a range of two numbers, the smaller one first: give its board's firmware the "
                   "converter's range");
  }
  const settings::AmplifierSection& amplifier = config.driver->voltage;
  const double zero_V = -amplifier.offset / amplifier.scale;
  if (zero_V >= identity.output_min_V && zero_V <= identity.output_max_V) return;
  throw KeyError(
      config.file, "driver.voltage.offset", ShortestNumber(amplifier.offset),
      fmt::format(
          "one with which zero volts are within the front end's output, {:.6g} to {:.6g} V at the terminal",
          identity.output_min_V, identity.output_max_V));
}

void SetLimits(const settings::StackConfig& config, hydro_settings* settings) {
  const auto& driver = *config.driver;
  const model::Parameters& parameters = config.model.description.parameters;
  const bool loop = settings->mode == HYDRO_LOOP_ON_DEVICE;
  if (std::isfinite(driver.voltage.limit_V)) Single(config, "driver.voltage.limit_V", driver.voltage.limit_V);
  settings->voltage_limit = RoundedDown(std::min(driver.voltage.limit_V, parameters.T_pmax / parameters.k_1));
  settings->pressure_limit = RoundedUp(config.limits.pressure_psi);
  settings->motor_speed_limit = RoundedUp(config.limits.motor_speed_rad_s);
  const bool measured = driver.arm_angle.source != Source::kNone;
  settings->arm_angle_limit =
      measured ? RoundedUp(config.limits.arm_angle_rad) : std::numeric_limits<float>::infinity();
  settings->reference_limit = loop ? RoundedUp(1.000001 * tuning::ValuesOf(config).position.pressure_limit)
                                   : std::numeric_limits<float>::infinity();
}

}  // namespace

std::array<const settings::SensorSection*, HYDRO_SENSORS> SensorSections(
    const settings::DriverSection& driver) {
  return {&driver.p1,          &driver.p2,        &driver.motor_angle,
          &driver.motor_speed, &driver.arm_angle, &driver.arm_speed};
}

hydro_settings FrontEndSettings(const settings::StackConfig& config, const hydro_identity& identity) {
  const settings::DriverSection& driver = *config.driver;
  hydro_settings settings{};
  settings.mode =
      driver.front_end.mode == settings::FrontEndMode::kRemoteIo ? HYDRO_REMOTE_IO : HYDRO_LOOP_ON_DEVICE;
  CheckMode(config, identity, settings.mode);
  settings.sample_interval_ticks = SampleInterval(config, identity);
  settings.watchdog_ticks = WatchdogTicks(config, identity);
  settings.transfer_ticks =
      static_cast<uint32_t>(std::min(std::round(config.limits.transfer_s * identity.tick_rate_hz), 4e9));
  CheckOutput(config, identity);
  SetLimits(config, &settings);
  settings.output_scale = Single(config, "driver.voltage.scale", driver.voltage.scale);
  settings.output_offset = Single(config, "driver.voltage.offset", driver.voltage.offset);
  settings.read_back_tolerance =
      Single(config, "driver.read_back_tolerance_V", driver.front_end.read_back_tolerance_V);
  const auto sections = SensorSections(driver);
  for (int i = 0; i < HYDRO_SENSORS; ++i) {
    settings.sensors[i] = SensorSettings(config, SensorName(i), *sections[static_cast<size_t>(i)], identity);
  }
  return settings;
}

}  // namespace hydro::plant
