// The numbers by which the loops act, as they travel in tuned_settings_t: gains as derived, so that no loop parses or derives.
#pragma once

#include <hydro/tuned_settings_t.hpp>
#include <string>

#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "settings/stack_config.h"

namespace hydro::tuning {

struct TunedValues {
  pressure_ctrl::PressureLawSettings pressure;  // eq. (16)
  position_ctrl::PositionLawSettings position;  // eq. (17); its pressure limit follows from the torque's
  double braking;                  // rad/s^2, of the braking curve before eq. (17); infinity: none
  settings::LimitsSection limits;  // only those of tunable_keys.h are sent
  settings::NoiseSection noise;    // standard deviations only
};

// Throws InputError when gains cannot be derived.
TunedValues ValuesOf(const settings::StackConfig& config);

// Whether both loops' laws are the same, whatever the limits and the noise.
bool SameLaws(const TunedValues& a, const TunedValues& b);

// Fills names and values.
void Write(const TunedValues& values, tuned_settings_t* message);

// Takes the values that the message names into `values`, and derives from them what follows: the position law's pressure limit,
// with k_2 (in-lbf/psi). Returns what is wrong with it, as one line, and leaves
// `values` alone then: an unknown name, a value that is not a number or out of its range, names without values.
std::string Read(const tuned_settings_t& message, double k_2, TunedValues* values);

}  // namespace hydro::tuning
