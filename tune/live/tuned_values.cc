#include "tune/live/tuned_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/number_text.h"
#include "settings/quantity_keys.h"
#include "tune/design/configured_laws.h"

namespace hydro::tuning {
namespace {

struct Value {
  std::string_view name;
  double (*get)(const TunedValues&);
  void (*set)(TunedValues&, double);
};

constexpr std::array kValues{
    Value{"pressure.k_p", [](const TunedValues& v) { return v.pressure.gains.k_p; },
          [](TunedValues& v, double x) { v.pressure.gains.k_p = x; }},
    Value{"pressure.k_v", [](const TunedValues& v) { return v.pressure.gains.k_v; },
          [](TunedValues& v, double x) { v.pressure.gains.k_v = x; }},
    Value{"pressure.reference_feedforward",
          [](const TunedValues& v) { return v.pressure.reference_feedforward; },
          [](TunedValues& v, double x) { v.pressure.reference_feedforward = x; }},
    Value{"pressure.arm_speed_ratio", [](const TunedValues& v) { return v.pressure.arm_speed_ratio; },
          [](TunedValues& v, double x) { v.pressure.arm_speed_ratio = x; }},
    Value{"position.c1", [](const TunedValues& v) { return v.position.c1; },
          [](TunedValues& v, double x) { v.position.c1 = x; }},
    Value{"position.c2", [](const TunedValues& v) { return v.position.c2; },
          [](TunedValues& v, double x) { v.position.c2 = x; }},
    Value{"position.derivative_on_error",
          [](const TunedValues& v) { return v.position.derivative_on_error ? 1.0 : 0.0; },
          [](TunedValues& v, double x) { v.position.derivative_on_error = x != 0; }},
    Value{"position.braking", [](const TunedValues& v) { return v.braking; },
          [](TunedValues& v, double x) { v.braking = x; }},
    Value{"limits.pressure", [](const TunedValues& v) { return v.limits.pressure_psi; },
          [](TunedValues& v, double x) { v.limits.pressure_psi = x; }},
    Value{"limits.motor_speed", [](const TunedValues& v) { return v.limits.motor_speed_rad_s; },
          [](TunedValues& v, double x) { v.limits.motor_speed_rad_s = x; }},
    Value{"limits.arm_angle", [](const TunedValues& v) { return v.limits.arm_angle_rad; },
          [](TunedValues& v, double x) { v.limits.arm_angle_rad = x; }},
    Value{"limits.arm_torque", [](const TunedValues& v) { return v.limits.arm_torque_in_lbf; },
          [](TunedValues& v, double x) { v.limits.arm_torque_in_lbf = x; }},
    Value{"noise.p1", [](const TunedValues& v) { return v.noise.p1_psi; },
          [](TunedValues& v, double x) { v.noise.p1_psi = x; }},
    Value{"noise.p2", [](const TunedValues& v) { return v.noise.p2_psi; },
          [](TunedValues& v, double x) { v.noise.p2_psi = x; }},
    Value{"noise.motor_angle", [](const TunedValues& v) { return v.noise.motor_angle_rad; },
          [](TunedValues& v, double x) { v.noise.motor_angle_rad = x; }},
    Value{"noise.motor_speed", [](const TunedValues& v) { return v.noise.motor_speed_rad_s; },
          [](TunedValues& v, double x) { v.noise.motor_speed_rad_s = x; }},
    Value{"noise.arm_angle", [](const TunedValues& v) { return v.noise.arm_angle_rad; },
          [](TunedValues& v, double x) { v.noise.arm_angle_rad = x; }},
    Value{"noise.arm_speed", [](const TunedValues& v) { return v.noise.arm_speed_rad_s; },
          [](TunedValues& v, double x) { v.noise.arm_speed_rad_s = x; }},
};

// Also finds the name used in older logs.
const Value* Find(const std::string& name) {
  const bool gain = name == "pressure.reference_feedforward_V_psi";
  const std::string present = gain ? "pressure.reference_feedforward" : settings::PresentName(name);
  for (const Value& value : kValues) {
    if (value.name == present) return &value;
  }
  return nullptr;
}

// A limit may be infinite; a feed-forward may have either sign; nothing else is below 0.
std::string WhatIsWrong(const std::string& name, double value) {
  const bool limit = name.starts_with("limits.") || name == "position.braking";
  const bool good = limit ? value > 0
                          : std::isfinite(value) && (value >= 0 || name == "pressure.reference_feedforward" ||
                                                     name == "pressure.arm_speed_ratio");
  return good ? ""
              : name + ": found " + ShortestNumber(value) + ", allowed " +
                    (limit ? "a number above 0" : "a finite number of at least 0");
}

}  // namespace

TunedValues ValuesOf(const settings::StackConfig& config) {
  return {.pressure = design::PressureLawSettingsFor(config),
          .position = design::PositionLawSettingsFor(config),
          .braking = config.position.braking_rad_s2.value_or(std::numeric_limits<double>::infinity()),
          .limits = config.limits,
          .noise = config.noise};
}

bool SameLaws(const TunedValues& a, const TunedValues& b) {
  return std::all_of(kValues.begin(), kValues.end(), [&](const Value& value) {
    const bool of_a_law = !value.name.starts_with("limits.") && !value.name.starts_with("noise.");
    return !of_a_law || value.get(a) == value.get(b);
  });
}

void Write(const TunedValues& values, tuned_settings_t* message) {
  message->count = static_cast<int32_t>(kValues.size());
  message->names.clear();
  message->values.clear();
  message->names.reserve(kValues.size());
  message->values.reserve(kValues.size());
  for (const Value& value : kValues) {
    message->names.emplace_back(value.name);
    message->values.push_back(value.get(values));
  }
}

std::string Read(const tuned_settings_t& message, double k_2, TunedValues* values) {
  TunedValues changed = *values;
  const auto count = static_cast<size_t>(message.count);
  if (message.names.size() != count || message.values.size() != count)
    return "names and values differ in number";
  for (size_t i = 0; i < count; ++i) {
    const Value* value = Find(message.names[i]);
    if (value == nullptr) return message.names[i] + ": not known to this version";
    if (std::string wrong = WhatIsWrong(std::string(value->name), message.values[i]); !wrong.empty())
      return wrong;
    value->set(changed, message.values[i]);
  }
  changed.position.pressure_limit = changed.limits.arm_torque_in_lbf / k_2;
  *values = changed;
  return "";
}

}  // namespace hydro::tuning
