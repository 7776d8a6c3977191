#include "tuning/tunable_keys.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/did_you_mean.h"

namespace hydro::tuning {
namespace {

constexpr std::string_view kPressure = "pressure_ctrl", kPosition = "position_ctrl", kPlant = "plant";

constexpr std::string_view kReach = "within the limits";
constexpr std::string_view kTighter = "> 0, as in force or less";  // wider: while all is held at zero volts
constexpr std::string_view kSimulated = ">= 0";                    // a simulated rig's alone

constexpr std::array kKeys{
    TunableKey{"pressure.k_p", "V/psi", ">= 0", "gain on the pressure error, eq. (16)", kPressure},
    TunableKey{"pressure.k_v", "psi s/rad", ">= 0", "gain on the motor's speed, eq. (16)", kPressure},
    TunableKey{"pressure.natural_frequency_rad_s", "rad/s", "> 0", "of the pressure loop; k_p and k_v follow",
               kPressure},
    TunableKey{"pressure.damping_ratio", "1", "> 0", "of the pressure loop; k_p and k_v follow", kPressure},
    TunableKey{"pressure.compressed_sides", "1", "1, 2", "the case for which k_p and k_v are derived",
               kPressure},
    TunableKey{"pressure.reference_feedforward", "V/psi", "true, false, any number",
               "adds the voltage that holds dp_ref; a number is its gain", kPressure},
    TunableKey{"pressure.arm_speed_feedforward", "", "true, false",
               "takes the arm's motion out of the k_v term", kPressure},
    TunableKey{"position.c1", "psi/rad", ">= 0", "gain on the arm's angle error, eq. (17)", kPosition},
    TunableKey{"position.c2", "psi s/rad", ">= 0", "gain on its derivative, eq. (17)", kPosition},
    TunableKey{"position.derivative", "", "\"error\", \"measurement\"", "what eq. (17) differentiates",
               kPosition},
    TunableKey{"position.braking_rad_s2", "rad/s^2", "> 0",
               "deceleration of the braking curve before eq. (17)", kPosition},
    TunableKey{"reference.kind", "", "steps, sine, square, chirp, csv, planner",
               "what the reference is; csv: points", kPosition},
    TunableKey{"reference.initial", "rad, psi, in-lbf or V", kReach, "before the first step or plan",
               kPosition},
    TunableKey{"reference.steps", "s, and as initial", kReach, "[[time, value], ...]", kPosition},
    TunableKey{"reference.offset", "rad, psi, in-lbf or V", kReach, "middle of a sine, square or chirp",
               kPosition},
    TunableKey{"reference.amplitude", "rad, psi, in-lbf or V", kReach, "of a sine, square or chirp",
               kPosition},
    TunableKey{"reference.frequency_hz", "Hz", "> 0", "of a sine or square", kPosition},
    TunableKey{"reference.phase_rad", "rad", "any number", "of a sine", kPosition},
    TunableKey{"reference.start_s", "s", "any number", "when a sine, square or chirp begins", kPosition},
    TunableKey{"reference.first_frequency_hz", "Hz", ">= 0", "of a chirp", kPosition},
    TunableKey{"reference.last_frequency_hz", "Hz", "> 0", "of a chirp", kPosition},
    TunableKey{"reference.duration_s", "s", "> 0", "of a chirp", kPosition},
    TunableKey{"reference.points", "s, and as initial", kReach, "[[time, value], ...] of a csv reference",
               kPosition},
    TunableKey{"reference.interpolation", "", "\"linear\", \"hold\"", "between points", kPosition},
    TunableKey{"reference.timeout_s", "s", "> 0, <= 1e6", "a plan older than this is followed no further",
               kPosition},
    TunableKey{"reference.max_speed_rad_s", "rad/s", "> 0", "of the reference that follows a planner",
               kPosition},
    TunableKey{"limits.pressure_psi", "psi", kTighter, "above it on either side: zero volts and a fault",
               kPressure},
    TunableKey{"limits.motor_speed_rad_s", "rad/s", kTighter, "above it: zero volts and a fault", kPressure},
    TunableKey{"limits.arm_angle_rad", "rad", kTighter, "beyond it: zero volts and a fault", kPressure},
    TunableKey{"limits.arm_torque_in_lbf", "in-lbf", kTighter, "what the position loop may ask for",
               kPosition},
    TunableKey{"noise.p1_psi", "psi", kSimulated, "standard deviation of the simulated sensor's noise",
               kPlant},
    TunableKey{"noise.p2_psi", "psi", kSimulated, "standard deviation of the simulated sensor's noise",
               kPlant},
    TunableKey{"noise.motor_angle_rad", "rad", kSimulated,
               "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.motor_speed_rad_s", "rad/s", kSimulated,
               "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.arm_angle_rad", "rad", kSimulated, "standard deviation of the simulated sensor's noise",
               kPlant},
    TunableKey{"noise.arm_speed_rad_s", "rad/s", kSimulated,
               "standard deviation of the simulated sensor's noise", kPlant},
};

}  // namespace

std::span<const TunableKey> TunableKeys() { return kKeys; }

const TunableKey* FindTunable(std::string_view key) {
  const auto found =
      std::find_if(kKeys.begin(), kKeys.end(), [&](const auto& row) { return row.key == key; });
  return found == kKeys.end() ? nullptr : &*found;
}

std::string WhyNotTunable(const std::string& key) {
  std::vector<std::string> names;
  names.reserve(kKeys.size());
  for (const TunableKey& row : kKeys) names.emplace_back(row.key);
  if (key.find('.') == std::string::npos) {  // the section is missing
    for (const std::string& name : names) {
      if (name.ends_with("." + key)) return key + ": no such value, did you mean " + name + "?";
    }
  }
  const std::string meant = DidYouMean(key, names);
  if (!meant.empty()) return key + ": no such value" + meant;
  return key +
         ": cannot be changed while the stack runs (hydro-set --list shows what can); change the "
         "configuration and restart";
}

}  // namespace hydro::tuning
