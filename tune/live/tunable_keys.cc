#include "tune/live/tunable_keys.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/word_list.h"
#include "settings/quantity_keys.h"
#include "settings/stack_sections.h"

namespace hydro::tuning {
namespace {

constexpr std::string_view kPressure = "pressure_ctrl", kPosition = "position_ctrl", kPlant = "plant";

constexpr std::string_view kReach = "within the limits";
// A limit may become wider only while the voltage is held at zero.
constexpr std::string_view kTighter = "> 0, as in force or less";
constexpr std::string_view kSimulated = ">= 0";  // for a simulated rig only

constexpr std::array kKeys{
    TunableKey{"pressure.k_p", ">= 0", "gain on the pressure error, eq. (16)", kPressure},
    TunableKey{"pressure.k_v", ">= 0", "gain on the motor's speed, eq. (16)", kPressure},
    TunableKey{"pressure.natural_frequency_rad_s", "> 0", "of the pressure loop; k_p and k_v follow",
               kPressure},
    TunableKey{"pressure.damping_ratio", "> 0", "of the pressure loop; k_p and k_v follow", kPressure},
    TunableKey{"pressure.compressed_sides", "1, 2", "the case for which k_p and k_v are derived", kPressure},
    TunableKey{"pressure.reference_feedforward", "true, false, any number",
               "adds the voltage that holds dp_ref; a number is its gain", kPressure},
    TunableKey{"pressure.arm_speed_feedforward", "true, false", "takes the arm's motion out of the k_v term",
               kPressure},
    TunableKey{"position.c1", ">= 0", "gain on the arm's angle error, eq. (17)", kPosition},
    TunableKey{"position.c2", ">= 0", "gain on its derivative, eq. (17)", kPosition},
    TunableKey{"position.derivative", "\"error\", \"measurement\"", "what eq. (17) differentiates",
               kPosition},
    TunableKey{"position.braking", "> 0", "deceleration of the braking curve before eq. (17)", kPosition},
    TunableKey{"reference.kind", "steps, sine, square, chirp, csv, planner",
               "what the reference is; csv: points", kPosition},
    TunableKey{"reference.initial", kReach, "before the first step or plan", kPosition},
    TunableKey{"reference.steps", kReach, "[[time, value], ...]", kPosition},
    TunableKey{"reference.offset", kReach, "middle of a sine, square or chirp", kPosition},
    TunableKey{"reference.amplitude", kReach, "of a sine, square or chirp", kPosition},
    TunableKey{"reference.frequency_hz", "> 0", "of a sine or square", kPosition},
    TunableKey{"reference.phase_rad", "any number", "of a sine", kPosition},
    TunableKey{"reference.start_s", "any number", "when a sine, square or chirp begins", kPosition},
    TunableKey{"reference.first_frequency_hz", ">= 0", "of a chirp", kPosition},
    TunableKey{"reference.last_frequency_hz", "> 0", "of a chirp", kPosition},
    TunableKey{"reference.duration_s", "> 0", "of a chirp", kPosition},
    TunableKey{"reference.points", kReach, "[[time, value], ...] of a csv reference", kPosition},
    TunableKey{"reference.interpolation", "\"linear\", \"hold\", \"cubic\"", "between points", kPosition},
    TunableKey{"reference.timeout_s", "> 0, <= 1e6", "a plan older than this is followed no further",
               kPosition},
    TunableKey{"reference.max_speed", "> 0", "of the reference that follows a planner", kPosition},
    TunableKey{"limits.pressure", kTighter, "above it on either side: zero volts and a fault", kPressure},
    TunableKey{"limits.motor_speed", kTighter, "above it: zero volts and a fault", kPressure},
    TunableKey{"limits.arm_angle", kTighter, "beyond it: zero volts and a fault", kPressure},
    TunableKey{"limits.arm_torque", kTighter, "what the position loop may ask for", kPosition},
    TunableKey{"noise.p1", kSimulated, "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.p2", kSimulated, "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.motor_angle", kSimulated, "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.motor_speed", kSimulated, "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.arm_angle", kSimulated, "standard deviation of the simulated sensor's noise", kPlant},
    TunableKey{"noise.arm_speed", kSimulated, "standard deviation of the simulated sensor's noise", kPlant},
};

}  // namespace

std::span<const TunableKey> TunableKeys() { return kKeys; }

const TunableKey* FindTunable(std::string_view key) {
  const std::string present = settings::PresentName(std::string(key));
  const auto found =
      std::find_if(kKeys.begin(), kKeys.end(), [&](const auto& row) { return row.key == present; });
  return found == kKeys.end() ? nullptr : &*found;
}

std::string UnitOf(const TunableKey& row, const settings::StackConfig& config) {
  const std::string_view signals[] = {"arm_angle", "pressure", "torque", "voltage"};
  const std::string unit = settings::UnitOfKey(row.key, config.model.description.units,
                                               signals[static_cast<size_t>(config.reference.signal)]);
  const bool pairs = row.key == "reference.steps" || row.key == "reference.points";
  return pairs ? "s, " + unit : unit;
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
  if (settings::KnowsKey(key)) {
    return key +
           ": cannot be changed while the stack runs (hydro-set --list shows what can); change the "
           "configuration and restart";
  }
  const std::string meant = DidYouMean(key, names);
  return key + ": no such value" + (meant.empty() ? "; hydro-set --list shows what can be changed" : meant);
}

}  // namespace hydro::tuning
