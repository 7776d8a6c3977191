// The settings of the two control laws that follow from a configuration.
#pragma once

#include <optional>

#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "settings/stack_config.h"

namespace hydro::design {

// Settings of eq. (16). Derives the gains when the configuration gives natural frequency and damping ratio
// instead. Throws InputError when they cannot be derived.
pressure_ctrl::PressureLawSettings PressureLawSettingsFor(const settings::StackConfig& config);

// Settings of eq. (17).
position_ctrl::PositionLawSettings PositionLawSettingsFor(const settings::StackConfig& config);

// The braking curve before eq. (17); empty without position.braking_rad_s2. Its largest speed is 0.95 of
// limits.motor_speed.
std::optional<position_ctrl::BrakingCurve> BrakingCurveFor(const settings::StackConfig& config);

// The same curve from numbers: `braking` in rad/s^2, infinity for none; `motor_speed` is the motor's limit,
// rad/s.
std::optional<position_ctrl::BrakingCurve> BrakingCurveFor(const position_ctrl::PositionLawSettings& law,
                                                           double braking, double motor_speed,
                                                           const model::Parameters& parameters);

}  // namespace hydro::design
