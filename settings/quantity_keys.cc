#include "settings/quantity_keys.h"

#include <utility>

namespace hydro::settings {
namespace {

constexpr QuantityKey kQuantities[] = {
    {"model", "arm_angle", "rad", 1, "arm_angle_rad"},
    {"model", "initial_pressure", "psi", 0, "initial_pressure_psi"},
    {"pressure", "k_p", "V/psi"},
    {"pressure", "k_v", "psi s/rad"},
    {"pressure", "reference_feedforward", "V/psi"},
    {"position", "c1", "psi/rad", -1},
    {"position", "c2", "psi s/rad", -1},
    {"position", "braking", "rad/s^2", 1, "braking_rad_s2"},
    {"position", "dac_range", "psi", 0, "dac_range_psi"},
    {"reference", "max_speed", "rad/s", 1, "max_speed_rad_s"},
    {"limits", "pressure", "psi", 0, "pressure_psi"},
    {"limits", "motor_speed", "rad/s", 0, "motor_speed_rad_s"},
    {"limits", "arm_angle", "rad", 1, "arm_angle_rad"},
    {"limits", "arm_torque", "in-lbf", -1, "arm_torque_in_lbf"},
    {"noise", "p1", "psi", 0, "p1_psi"},
    {"noise", "p2", "psi", 0, "p2_psi"},
    {"noise", "motor_angle", "rad", 0, "motor_angle_rad"},
    {"noise", "motor_speed", "rad/s", 0, "motor_speed_rad_s"},
    {"noise", "arm_angle", "rad", 1, "arm_angle_rad"},
    {"noise", "arm_speed", "rad/s", 1, "arm_speed_rad_s"},
    {"noise", "p1_resolution", "psi", 0, "p1_resolution_psi"},
    {"noise", "p2_resolution", "psi", 0, "p2_resolution_psi"},
    {"noise", "motor_angle_resolution", "rad", 0, "motor_angle_resolution_rad"},
    {"noise", "motor_speed_resolution", "rad/s", 0, "motor_speed_resolution_rad_s"},
    {"noise", "arm_angle_resolution", "rad", 1, "arm_angle_resolution_rad"},
    {"noise", "arm_speed_resolution", "rad/s", 1, "arm_speed_resolution_rad_s"},
    {"arm", "gravity", "in/s^2"},
    {"arm", "payload", "lbf-s^2/in"},
    {"arm.link", "mass", "lbf-s^2/in"},
    {"arm.link", "length", "in"},
    {"arm.link", "centre", "in"},
    {"arm.link", "inertia", "lbf-in-s^2"},
};

// Keys whose unit is part of the name, the same in every system of units.
constexpr std::pair<std::string_view, std::string_view> kSharedUnits[] = {
    {"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_hz", "Hz"}, {"_s", "s"}};

// Whether the key holds values of a trajectory.
bool IsValue(std::string_view key) {
  return key == "initial" || key == "offset" || key == "amplitude" || key == "steps" || key == "points";
}

struct Quantity {
  std::string_view unit;
  int arm = 0;
};

Quantity OfSignal(std::string_view signal) {
  if (signal == "pressure") return {"psi"};
  if (signal == "torque") return {"in-lbf", -1};
  if (signal == "voltage") return {"V"};
  return {"rad", 1};
}

const QuantityKey* Find(std::string_view section, std::string_view key) {
  for (const QuantityKey& one : kQuantities) {
    if (one.section == section && (one.key == key || (!one.old.empty() && one.old == key))) return &one;
  }
  return nullptr;
}

std::string Unit(std::string_view section, std::string_view key, const UnitSystem& units,
                 std::string_view signal) {
  if (const QuantityKey* found = Find(section, key)) return found->UnitIn(units);
  if ((section == "reference" || section == "model.motion") && IsValue(key)) {
    const Quantity value = OfSignal(section == "reference" ? signal : "arm_angle");
    return units.UnitFor(std::string(value.unit), value.arm);
  }
  for (const auto& [ending, unit] : kSharedUnits) {
    if (key.ends_with(ending)) return std::string(unit);
  }
  return "";
}

}  // namespace

std::span<const QuantityKey> QuantityKeys() { return kQuantities; }

const QuantityKey* FindQuantity(std::string_view dotted_key) {
  const size_t dot = dotted_key.rfind('.');
  if (dot == std::string_view::npos) return nullptr;
  return Find(dotted_key.substr(0, dot), dotted_key.substr(dot + 1));
}

std::string PresentName(const std::string& dotted_key) {
  const QuantityKey* found = FindQuantity(dotted_key);
  return found == nullptr ? dotted_key : std::string(found->section) + "." + std::string(found->key);
}

std::string UnitOfKey(std::string_view dotted_key, const UnitSystem& units, std::string_view signal) {
  const size_t dot = dotted_key.rfind('.');
  if (dot == std::string_view::npos) return "";
  return Unit(dotted_key.substr(0, dot), dotted_key.substr(dot + 1), units, signal);
}

}  // namespace hydro::settings
