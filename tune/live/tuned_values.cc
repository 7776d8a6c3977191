#include "tune/live/tuned_values.h"

#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/number_text.h"
#include "settings/quantity_keys.h"
#include "tune/design/configured_laws.h"

namespace hydro::tuning {
namespace {

// Calls visit(name, place) for each value, with its place in a TunedValues.
template <class Values, class Visit>
void ForEach(Values& v, const Visit& visit) {
  visit("pressure.k_p", v.pressure.gains.k_p);
  visit("pressure.k_v", v.pressure.gains.k_v);
  visit("pressure.reference_feedforward", v.pressure.reference_feedforward);
  visit("pressure.arm_speed_ratio", v.pressure.arm_speed_ratio);
  visit("position.c1", v.position.c1);
  visit("position.c2", v.position.c2);
  visit("position.derivative_on_error", v.position.derivative_on_error);
  visit("position.braking", v.braking);
  visit("limits.pressure", v.limits.pressure_psi);
  visit("limits.motor_speed", v.limits.motor_speed_rad_s);
  visit("limits.arm_angle", v.limits.arm_angle_rad);
  visit("limits.arm_torque", v.limits.arm_torque_in_lbf);
  visit("noise.p1", v.noise.p1_psi);
  visit("noise.p2", v.noise.p2_psi);
  visit("noise.motor_angle", v.noise.motor_angle_rad);
  visit("noise.motor_speed", v.noise.motor_speed_rad_s);
  visit("noise.arm_angle", v.noise.arm_angle_rad);
  visit("noise.arm_speed", v.noise.arm_speed_rad_s);
}

// Today's name for one that may be an older log's.
std::string PresentNameOf(const std::string& name) {
  return name == "pressure.reference_feedforward_V_psi" ? "pressure.reference_feedforward"
                                                        : settings::PresentName(name);
}

// Returns false when no value has that name.
bool Set(const std::string& name, double value, TunedValues* values) {
  bool found = false;
  ForEach(*values, [&](std::string_view one, auto& place) {
    if (one != name) return;
    place = static_cast<std::remove_reference_t<decltype(place)>>(value);
    found = true;
  });
  return found;
}

std::vector<double> OfTheLaws(const TunedValues& values) {
  std::vector<double> all;
  ForEach(values, [&](std::string_view name, double value) {
    if (!name.starts_with("limits.") && !name.starts_with("noise.")) all.push_back(value);
  });
  return all;
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

bool SameLaws(const TunedValues& a, const TunedValues& b) { return OfTheLaws(a) == OfTheLaws(b); }

void Write(const TunedValues& values, tuned_settings_t* message) {
  message->names.clear();
  message->values.clear();
  ForEach(values, [&](std::string_view name, double value) {
    message->names.emplace_back(name);
    message->values.push_back(value);
  });
  message->count = static_cast<int32_t>(message->names.size());
}

std::string Read(const tuned_settings_t& message, double k_2, TunedValues* values) {
  TunedValues changed = *values;
  const auto count = static_cast<size_t>(message.count);
  if (message.names.size() != count || message.values.size() != count)
    return "names and values differ in number";
  for (size_t i = 0; i < count; ++i) {
    const std::string name = PresentNameOf(message.names[i]);
    if (!Set(name, message.values[i], &changed)) return message.names[i] + ": not known to this version";
    if (std::string wrong = WhatIsWrong(name, message.values[i]); !wrong.empty()) return wrong;
  }
  changed.position.pressure_limit = changed.limits.arm_torque_in_lbf / k_2;
  *values = changed;
  return "";
}

}  // namespace hydro::tuning
