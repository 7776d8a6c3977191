#include "plant/front_end/refusals.h"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstring>

#include "base/text_file.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

constexpr std::array<const char*, HYDRO_SENSORS> kSensorNames = {"p1",          "p2",        "motor_angle",
                                                                 "motor_speed", "arm_angle", "arm_speed"};

// In the order of the bits.
constexpr std::array<const char*, 11> kFaultNames = {"no valid command within driver.watchdog_s (watchdog)",
                                                     "a command that is not finite or beyond its limit",
                                                     "a command made for other settings",
                                                     "p1 or p2 above limits.pressure",
                                                     "the motor beyond limits.motor_speed",
                                                     "the arm beyond limits.arm_angle",
                                                     "a sensor that is not credible",
                                                     "an output that is not what was written",
                                                     "converters that do not answer",
                                                     "a tick that took longer than its time",
                                                     "an open emergency stop or enable input"};

struct Refusal {
  const char* key;
  const char* why;
};

Refusal RefusalOf(uint8_t refused) {
  switch (refused) {
    case HYDRO_REFUSED_ARMED:
      return {"driver.url", "it is armed; settings change at zero volts only"};
    case HYDRO_REFUSED_MODE:
      return {"driver.mode", "its firmware does not have this mode"};
    case HYDRO_REFUSED_INTERVAL:
      return {"plant.rate_hz", "it cannot send samples this rarely: raise it"};
    case HYDRO_REFUSED_WATCHDOG:
      return {"driver.watchdog_s", "it takes from one of its ticks to a second"};
    case HYDRO_REFUSED_LIMIT:
      return {"limits", "one of them or driver.voltage.limit_V is not a number above 0 to it"};
    case HYDRO_REFUSED_OUTPUT:
      return {"driver.voltage", "scale, offset or driver.read_back_tolerance_V is not one that it can use"};
    case HYDRO_REFUSED_SENSOR:
      return {"driver.url", "of a sensor, it has no such channel, or cannot use these numbers"};
    case HYDRO_REFUSED_MISSING:
      return {"driver", "a sensor is missing that the mode or a limit needs"};
    case HYDRO_REFUSED_ZERO:
      return {"driver.voltage.offset", "its output cannot reach zero volts"};
    default:
      return {"driver.url", "for a reason that this version does not know: is its firmware newer?"};
  }
}

std::string BoardOf(const hydro_identity& identity) {
  return "\"" + Printable({identity.board, strnlen(identity.board, HYDRO_BOARD_NAME_BYTES)}) + "\"";
}

std::string FirmwareOf(const hydro_identity& identity) {
  return fmt::format("firmware {}.{}.{}", identity.firmware[0], identity.firmware[1], identity.firmware[2]);
}

std::string OutputOf(const hydro_identity& identity) {
  return fmt::format("an output from {:.6g} to {:.6g} V", identity.output_min_V, identity.output_max_V);
}

}  // namespace

const char* SensorName(int index) { return kSensorNames[static_cast<size_t>(index)]; }

InputError RefusalError(const std::string& file, const hydro_settings_held& held) {
  const Refusal refusal = RefusalOf(held.refused);
  std::string key = refusal.key;
  if (held.refused == HYDRO_REFUSED_SENSOR && held.refused_part < HYDRO_SENSORS)
    key = std::string("driver.") + SensorName(held.refused_part);
  return settings::KeyError(file, key,
                            fmt::format("settings that the front end refuses (its number {})", held.refused),
                            std::string("those that it takes: ") + refusal.why);
}

std::string DescribeRefusal(const hydro_settings_held& held) {
  return fmt::format("{} (its number {})", RefusalOf(held.refused).why, held.refused);
}

std::string DescribeChange(const hydro_identity& before, const hydro_identity& now) {
  std::string list;
  const auto compare = [&](const std::string& was, const std::string& is) {
    if (was != is) list += fmt::format("{}{} ({} before)", list.empty() ? "" : ", ", is, was);
  };
  compare("board " + BoardOf(before), "board " + BoardOf(now));
  compare(FirmwareOf(before), FirmwareOf(now));
  compare(fmt::format("modes {}", before.modes), fmt::format("modes {}", now.modes));
  compare(fmt::format("{} ticks/s", before.tick_rate_hz), fmt::format("{} ticks/s", now.tick_rate_hz));
  compare(fmt::format("{} analog inputs", before.analog_inputs),
          fmt::format("{} analog inputs", now.analog_inputs));
  compare(fmt::format("{} counters", before.counters), fmt::format("{} counters", now.counters));
  compare(OutputOf(before), OutputOf(now));
  return list;
}

std::string DescribeDeviceFaults(uint16_t faults) {
  std::string list;
  for (size_t bit = 0; bit < 16; ++bit) {
    if ((faults & (1U << bit)) == 0) continue;
    if (!list.empty()) list += "; ";
    list += bit < kFaultNames.size() ? kFaultNames[bit] : "a fault that this version does not know";
  }
  return list;
}

}  // namespace hydro::plant
