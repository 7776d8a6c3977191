#include "tune/design/configured_laws.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/input_error.h"
#include "model/sides.h"

namespace hydro::design {

pressure_ctrl::PressureLawSettings PressureLawSettingsFor(const settings::StackConfig& config) {
  const model::Parameters& parameters = config.model.description.parameters;
  const model::Differences differ = model::DifferencesOf(config.model.description);
  const settings::PressureSection& section = config.pressure;
  pressure_ctrl::PressureLawSettings law;
  try {
    law.gains = section.k_p ? pressure_ctrl::PressureGains{*section.k_p, section.k_v.value_or(0)}
                            : pressure_ctrl::DerivePressureGains(
                                  parameters, 0, section.natural_frequency_rad_s.value(),
                                  section.damping_ratio.value(), section.compressed_sides, differ);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: pressure.natural_frequency_rad_s: {}", config.file, error.what()));
  }
  law.voltage_limit = parameters.T_pmax / parameters.k_1;
  if (section.reference_feedforward_V_psi) {
    law.reference_feedforward = *section.reference_feedforward_V_psi;
  } else if (section.reference_feedforward) {
    law.reference_feedforward = pressure_ctrl::SteadyStateFeedforward(parameters, law.gains);
  }
  law.sides = {differ.areas, differ.displacements, parameters.p_3};
  if (section.arm_speed_feedforward) law.arm_speed_ratio = parameters.c / parameters.D;
  return law;
}

position_ctrl::PositionLawSettings PositionLawSettingsFor(const settings::StackConfig& config) {
  position_ctrl::PositionLawSettings settings;
  settings.c1 = config.position.c1;
  settings.c2 = config.position.c2;
  settings.sample_interval = static_cast<double>(config.position_interval_ticks) / config.plant.rate_hz;
  settings.derivative_on_error = config.position.derivative_on_error;
  settings.pressure_limit = config.limits.arm_torque_in_lbf / config.model.description.parameters.k_2;
  return settings;
}

std::optional<position_ctrl::BrakingCurve> BrakingCurveFor(const settings::StackConfig& config) {
  return BrakingCurveFor(PositionLawSettingsFor(config),
                         config.position.braking_rad_s2.value_or(std::numeric_limits<double>::infinity()),
                         config.limits.motor_speed_rad_s, config.model.description.parameters);
}

std::optional<position_ctrl::BrakingCurve> BrakingCurveFor(const position_ctrl::PositionLawSettings& law,
                                                           double braking, double motor_speed,
                                                           const model::Parameters& parameters) {
  if (!std::isfinite(braking)) return std::nullopt;
  return position_ctrl::BrakingCurve(law.c1 / law.c2, braking,
                                     0.95 * motor_speed * parameters.D / parameters.c);
}

}  // namespace hydro::design
