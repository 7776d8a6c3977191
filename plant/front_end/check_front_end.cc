#include "plant/front_end/check_front_end.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstdio>
#include <string>

#include "bus/clock.h"
#include "plant/front_end/front_end_rig.h"
#include "plant/front_end/front_end_settings.h"
#include "plant/front_end/refusals.h"
#include "process/stop_signal.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using Source = settings::SensorSection::Source;

constexpr auto kReadPeriod = 5ms;
constexpr auto kTablePeriod = 500ms;

std::string UnitOf(int sensor, const UnitSystem& units) {
  if (sensor == HYDRO_P1 || sensor == HYDRO_P2) return units.UnitFor("psi");
  const bool speed = sensor == HYDRO_MOTOR_SPEED || sensor == HYDRO_ARM_SPEED;
  return units.UnitFor(speed ? "rad/s" : "rad", sensor >= HYDRO_ARM_ANGLE ? 1 : 0);
}

std::string SourceOf(const settings::SensorSection& section) {
  switch (section.source) {
    case Source::kAnalog:
      return fmt::format("analog {}", section.line.channel);
    case Source::kCounter:
      return fmt::format("counter {}", section.line.channel);
    case Source::kDerivative:
      return "rate of the angle";
    case Source::kNone:
      break;
  }
  return "not measured";
}

void PrintTable(const settings::StackConfig& config, const model::Measurement& measured,
                const FrontEndRig& rig) {
  const settings::DriverSection& driver = *config.driver;
  const std::array<double, HYDRO_SENSORS> values = {measured.p1,          measured.p2,
                                                    measured.motor_angle, measured.motor_speed,
                                                    measured.arm_angle,   measured.arm_speed};
  const auto sections = SensorSections(driver);
  for (int i = 0; i < HYDRO_SENSORS; ++i) {
    const double value = values[static_cast<size_t>(i)];
    const std::string signal =
        std::isnan(value) ? "-" : fmt::format("{:.5g} {}", value, UnitOf(i, config.model.description.units));
    std::printf("%-12s %-18s %18s\n", SensorName(i), SourceOf(*sections[static_cast<size_t>(i)]).c_str(),
                signal.c_str());
  }
  for (const RigFault& fault : rig.faults()) std::printf("FAULT: %s\n", fault.text.c_str());
}

}  // namespace

int CheckFrontEnd(const settings::StackConfig& config, const bus::Clock& clock) {
  FrontEndRig rig(config, clock);
  rig.Connect();
  if (process::StopSignal() != 0) return 0;
  std::printf("%s: sensors only, the output stays at zero\n", rig.Describe().c_str());
  const auto start = clock.Now();
  const auto duration = bus::FromSeconds(config.time.duration_s);
  auto next_table = start + kTablePeriod;
  for (int64_t tick = 1;; ++tick) {
    const model::Measurement measured = rig.Read(tick);
    rig.Drive(0);  // the device obeys nothing; this only keeps the session
    const auto now = clock.Now();
    const bool last = process::StopSignal() != 0 || (config.time.duration_s > 0 && now - start >= duration);
    if (last || now >= next_table) {
      next_table = now + kTablePeriod;
      std::printf("after %.1f s\n", bus::ToSeconds(now - start));
      PrintTable(config, measured, rig);
      std::fflush(stdout);
    }
    if (last) return rig.faults().empty() ? 0 : 1;
    bus::SleepUntil(now + kReadPeriod);
  }
}

}  // namespace hydro::plant
