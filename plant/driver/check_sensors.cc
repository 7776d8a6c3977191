#include "plant/driver/check_sensors.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstdio>
#include <thread>

#include "process/stop_signal.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using Source = settings::SensorSection::Source;

// Readings are more frequent than tables, so that low passes and rates behave as in a run.
constexpr auto kReadPeriod = 5ms;
constexpr auto kTablePeriod = 500ms;

std::string UnitOf(const std::string& name, const UnitSystem& units) {
  if (name == "p1" || name == "p2") return units.UnitFor("psi");
  return units.UnitFor(name.ends_with("speed") ? "rad/s" : "rad", name.starts_with("arm_") ? 1 : 0);
}

}  // namespace

std::string DescribeReading(const BoardSensor& sensor, double value, const UnitSystem& units) {
  const BoardChannel& channel = sensor.channel();
  const bool analog = sensor.section().source == Source::kAnalog;
  std::string from = "not measured";
  std::string code;
  std::string volts;
  if (sensor.section().source == Source::kDerivative) from = "rate of the angle";
  if (analog || sensor.section().source == Source::kCounter) {
    from = fmt::format("{} {}/{}", analog ? "analog" : "counter", channel.subdevice, channel.channel);
    code = fmt::format("{}", sensor.code());
  }
  if (analog) volts = fmt::format("{:.4f} V", channel.converter.Volts(sensor.code()));
  const std::string signal =
      std::isnan(value) ? "-" : fmt::format("{:.5g} {}", value, UnitOf(sensor.name(), units));
  const std::string fault = sensor.fault() ? "  FAULT: " + sensor.fault()->text : "";
  return fmt::format("{:<12} {:<18} {:>10} {:>11} {:>18}{}", sensor.name(), from, code, volts, signal, fault);
}

int CheckSensors(const settings::StackConfig& config, const bus::Clock& clock) {
  ComediBoard board(config.file, config.driver->device, config.driver->settle_ns);
  BoardSensors sensors(board, *config.driver, clock);
  std::printf("%s: sensors only, the output is not touched\n", board.name().c_str());
  const auto start = clock.Now();
  const auto duration = bus::FromSeconds(config.time.duration_s);
  auto next_table = start + kTablePeriod;
  bool fault = false;
  for (bool last = false; !last;) {
    const model::Measurement measured = sensors.Read();
    const std::array<double, 6> values = {measured.p1,          measured.p2,        measured.motor_angle,
                                          measured.motor_speed, measured.arm_angle, measured.arm_speed};
    const auto now = clock.Now();
    last = process::StopSignal() != 0 || (config.time.duration_s > 0 && now - start >= duration);
    if (last || now >= next_table) {
      next_table = now + kTablePeriod;
      fault = false;
      std::printf("after %.1f s\n", bus::ToSeconds(now - start));
      for (size_t i = 0; i < values.size(); ++i) {
        const BoardSensor& sensor = *sensors.all()[i];
        std::printf("%s\n", DescribeReading(sensor, values[i], config.model.description.units).c_str());
        fault = fault || sensor.fault().has_value();
      }
      std::fflush(stdout);
    }
    if (!last) std::this_thread::sleep_for(kReadPeriod);
  }
  return fault ? 1 : 0;
}

}  // namespace hydro::plant
