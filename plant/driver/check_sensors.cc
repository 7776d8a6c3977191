#include "plant/driver/check_sensors.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstdio>
#include <thread>

#include "plant/driver/described_device.h"
#include "plant/driver/device_watch.h"
#include "process/stop_signal.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using Source = settings::SensorSection::Source;

// Readings are more frequent than tables so that low passes and rates behave as in a run.
constexpr auto kReadPeriod = 5ms;
constexpr auto kTablePeriod = 500ms;

std::string UnitOf(const std::string& name, const UnitSystem& units) {
  if (name == "p1" || name == "p2") return units.UnitFor("psi");
  return units.UnitFor(name.ends_with("speed") ? "rad/s" : "rad", name.starts_with("arm_") ? 1 : 0);
}

}  // namespace

std::string DescribeReading(const DeviceSensor& sensor, double value, const UnitSystem& units) {
  const DeviceInput& input = sensor.input();
  const Reading& reading = sensor.reading();
  std::string from = "not measured";
  std::string raw;
  std::string found;
  if (sensor.section().source == Source::kDerivative) from = "rate of the angle";
  if (!input.name.empty()) {
    const bool count = input.kind == DeviceInput::Kind::kCount;
    from = input.place.empty() ? (count ? "counter " : "analog ") + input.name : input.place;
    if (reading.raw) raw = fmt::format("{}", *reading.raw);
    if (!count) found = fmt::format("{:.4f} {}", reading.value, input.unit);
    if (count && raw.empty()) raw = fmt::format("{}", reading.value);
  }
  const std::string signal =
      std::isnan(value) ? "-" : fmt::format("{:.5g} {}", value, UnitOf(sensor.name(), units));
  const std::string fault = sensor.fault() ? "  FAULT: " + sensor.fault()->text : "";
  return fmt::format("{:<12} {:<18} {:>10} {:>11} {:>18}{}", sensor.name(), from, raw, found, signal, fault);
}

int CheckSensors(const settings::StackConfig& config, const bus::Clock& clock, Device& device) {
  const DeviceDescription description = Described(device, config.file);
  DeviceSensors sensors(description, config);
  std::printf("%s: sensors only, the output is not touched\n", description.name.c_str());
  const auto start = clock.Now();
  const auto duration = bus::FromSeconds(config.time.duration_s);
  DeviceWatch watch(description, bus::FromSeconds(config.limits.stale_input_s), start);
  DeviceReadings readings;
  readings.inputs.resize(description.inputs.size());
  auto next_table = start + kTablePeriod;
  bool fault = false;
  for (bool last = false; !last;) {
    ReadDevice(device, description, readings);
    const auto now = clock.Now();
    std::vector<RigFault> faults;
    const bool silent = watch.Look(readings, now, &faults);
    const model::Measurement measured = silent ? sensors.Nothing() : sensors.Take(readings, now);
    const std::array<double, 6> values = {measured.p1,          measured.p2,        measured.motor_angle,
                                          measured.motor_speed, measured.arm_angle, measured.arm_speed};
    last = process::StopSignal() != 0 || (config.time.duration_s > 0 && now - start >= duration);
    if (last || now >= next_table) {
      next_table = now + kTablePeriod;
      fault = !faults.empty();
      std::printf("after %.1f s\n", bus::ToSeconds(now - start));
      for (size_t i = 0; i < values.size(); ++i) {
        const DeviceSensor& sensor = *sensors.all()[i];
        std::printf("%s\n", DescribeReading(sensor, values[i], config.model.description.units).c_str());
        fault = fault || sensor.fault().has_value();
      }
      for (const RigFault& found : faults) std::printf("FAULT: %s\n", found.text.c_str());
      std::fflush(stdout);
    }
    if (!last) std::this_thread::sleep_for(kReadPeriod);
  }
  return fault ? 1 : 0;
}

}  // namespace hydro::plant
