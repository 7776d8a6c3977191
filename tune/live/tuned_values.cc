#include "tune/live/tuned_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

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

// At gives the value's place in a TunedValues.
template <class At>
constexpr Value Named(std::string_view name, At) {
  return {name, [](const TunedValues& v) { return static_cast<double>(At{}(v)); },
          [](TunedValues& v, double x) {
            auto& place = At{}(v);
            place = static_cast<std::remove_reference_t<decltype(place)>>(x);
          }};
}

constexpr std::array kValues{
    Named(
        "pressure.k_p", [](auto& v) -> auto& { return v.pressure.gains.k_p; }),
    Named(
        "pressure.k_v", [](auto& v) -> auto& { return v.pressure.gains.k_v; }),
    Named(
        "pressure.reference_feedforward", [](auto& v) -> auto& { return v.pressure.reference_feedforward; }),
    Named(
        "pressure.arm_speed_ratio", [](auto& v) -> auto& { return v.pressure.arm_speed_ratio; }),
    Named(
        "position.c1", [](auto& v) -> auto& { return v.position.c1; }),
    Named(
        "position.c2", [](auto& v) -> auto& { return v.position.c2; }),
    Named(
        "position.derivative_on_error", [](auto& v) -> auto& { return v.position.derivative_on_error; }),
    Named(
        "position.braking", [](auto& v) -> auto& { return v.braking; }),
    Named(
        "limits.pressure", [](auto& v) -> auto& { return v.limits.pressure_psi; }),
    Named(
        "limits.motor_speed", [](auto& v) -> auto& { return v.limits.motor_speed_rad_s; }),
    Named(
        "limits.arm_angle", [](auto& v) -> auto& { return v.limits.arm_angle_rad; }),
    Named(
        "limits.arm_torque", [](auto& v) -> auto& { return v.limits.arm_torque_in_lbf; }),
    Named(
        "noise.p1", [](auto& v) -> auto& { return v.noise.p1_psi; }),
    Named(
        "noise.p2", [](auto& v) -> auto& { return v.noise.p2_psi; }),
    Named(
        "noise.motor_angle", [](auto& v) -> auto& { return v.noise.motor_angle_rad; }),
    Named(
        "noise.motor_speed", [](auto& v) -> auto& { return v.noise.motor_speed_rad_s; }),
    Named(
        "noise.arm_angle", [](auto& v) -> auto& { return v.noise.arm_angle_rad; }),
    Named(
        "noise.arm_speed", [](auto& v) -> auto& { return v.noise.arm_speed_rad_s; }),
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
