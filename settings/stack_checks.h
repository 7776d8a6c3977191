// Checks that involve several keys of the configuration, or a key and the model.
#pragma once

#include <cstdint>

#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// The whole number of `unit`s in `value`, apart from rounding; 0 when it is not a whole number of at least
// one.
int64_t WholeMultiple(double value, double unit);

// Checks that the times fit the tick, and fills in the intervals in ticks and the last tick. Throws
// InputError.
void CheckTimes(const TomlNode& root, StackConfig* config);

// The share of V_ms/c, where V_1 or V_2 is 0, that a free arm may use when limits.arm_angle is not given.
inline constexpr double kArmAngleShare = 0.98;

// Checks pressures and arm angles against the model, once its description is known, and fills in the default
// of limits.arm_angle. Throws InputError.
void CheckAgainstModel(const TomlNode& root, StackConfig* config);

// Checks the gains and how the shaft is held. Throws InputError.
void CheckChoices(const TomlNode& root, const StackConfig& config);

}  // namespace hydro::settings
