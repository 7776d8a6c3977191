// The signals of a measured run by their names, here and in tables of hydro-log export.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::runs {

struct SignalName {
  MeasuredSignal MeasuredRun::*signal;
  const char* ours;      // in a sidecar
  const char* exported;  // in a table of ExportRun(), with the paper's unit; null: no log has it
  // In [noise] of a configuration; null: the signal has no sensor.
  const char* standard_deviation;
  const char* resolution;
  const char* unit;  // in the paper
  int arm = 0;       // power of the arm's coordinate in it
};

inline constexpr std::array<SignalName, 13> kSignals = {{
    {&MeasuredRun::voltage, "voltage", "voltage_V", nullptr, nullptr, "V"},
    {&MeasuredRun::pressure_ref, "pressure_ref", "pressure_ref_psi", nullptr, nullptr, "psi"},
    {&MeasuredRun::motor_speed, "motor_speed", "motor_speed_rad_s", "motor_speed", "motor_speed_resolution",
     "rad/s"},
    {&MeasuredRun::motor_angle, "motor_angle", "motor_angle_rad", "motor_angle", "motor_angle_resolution",
     "rad"},
    {&MeasuredRun::arm_angle, "arm_angle", "arm_angle_rad", "arm_angle", "arm_angle_resolution", "rad", 1},
    {&MeasuredRun::arm_speed, "arm_speed", "arm_speed_rad_s", "arm_speed", "arm_speed_resolution", "rad/s",
     1},
    {&MeasuredRun::p1, "p1", "p1_psi", "p1", "p1_resolution", "psi"},
    {&MeasuredRun::p2, "p2", "p2_psi", "p2", "p2_resolution", "psi"},
    {&MeasuredRun::dp, "dp", nullptr, nullptr, nullptr, "psi"},
    {&MeasuredRun::arm_force, "arm_force", nullptr, nullptr, nullptr, "in-lbf", -1},
    {&MeasuredRun::temperature, "temperature", nullptr, nullptr, nullptr, "degC"},
    {&MeasuredRun::motor_voltage, "motor_voltage", nullptr, nullptr, nullptr, "V"},
    {&MeasuredRun::bypass_valve, "bypass", nullptr, nullptr, nullptr, "1"},
}};

// Its key in the sidecar of the run, which texts use as its name. Where a current is commanded, `current` is
// the command and `voltage` was measured at the motor. Null: the sidecar has no key for it.
inline const char* KeyIn(const MeasuredRun& run, const SignalName& name) {
  if (name.signal == &MeasuredRun::voltage && run.current_commands) return "current";
  if (name.signal == &MeasuredRun::motor_voltage) return run.current_commands ? "voltage" : nullptr;
  return name.ours;
}
// All keys that [columns] of a sidecar may have.
inline std::vector<std::string> ColumnKeys() {
  std::vector<std::string> keys = {"time"};
  MeasuredRun run;
  for (const bool current : {false, true}) {
    run.current_commands = current;
    for (const SignalName& name : kSignals) {
      const char* key = KeyIn(run, name);
      if (key != nullptr && std::find(keys.begin(), keys.end(), key) == keys.end()) keys.emplace_back(key);
    }
  }
  return keys;
}

// Its unit in the run.
inline std::string UnitIn(const MeasuredRun& run, const SignalName& name) {
  if (name.signal == &MeasuredRun::voltage && run.current_commands) return "A";
  return run.units.UnitFor(name.unit, name.arm);
}

inline const std::vector<std::pair<std::string, model::Shaft>> kShafts = {
    {"clamped", model::Shaft::kClamped}, {"free", model::Shaft::kFree}, {"driven", model::Shaft::kDriven}};

}  // namespace hydro::runs
