// The numbers that the loops use, as tuned_settings_t carries them: gains are already derived, so that no
// loop parses or derives anything.
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

// Whether both have the same laws, regardless of limits and noise.
bool SameLaws(const TunedValues& a, const TunedValues& b);

// Fills names and values.
void Write(const TunedValues& values, tuned_settings_t* message);

// Copies the values that the message names into `values`, and derives the position law's pressure limit from
// them with k_2 (in-lbf/psi). If the message has a fault, it returns the fault as one line and does not
// change `values`: an unknown name, a value that is not a number or out of its range, names without values.
std::string Read(const tuned_settings_t& message, double k_2, TunedValues* values);

}  // namespace hydro::tuning
