#include "tune/search/gains.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/number_text.h"
#include "model/sides.h"
#include "tune/design/configured_laws.h"

namespace hydro::tune {
namespace {

// For a file that people read: drops digits that no rig could distinguish.
double Rounded(double value) { return ParseNumber(ShortNumber(value, 5)).value_or(value); }

}  // namespace

Gains GainsOf(const settings::StackConfig& config) {
  const settings::PressureSection& pressure = config.pressure;
  pressure_ctrl::SecondOrder loop;
  if (pressure.k_p) {
    loop = pressure_ctrl::PressureLoopDynamics(config.model.description.parameters, 0,
                                               design::PressureLawSettingsFor(config).gains, 2,
                                               model::DifferencesOf(config.model.description));
  } else {
    loop = {pressure.natural_frequency_rad_s.value_or(0), pressure.damping_ratio.value_or(0)};
  }
  return {.natural_frequency = loop.natural_frequency,
          .damping_ratio = loop.damping_ratio,
          .c1 = config.position.c1,
          .c2 = config.position.c2,
          .deceleration = config.position.braking_rad_s2.value_or(std::numeric_limits<double>::infinity()),
          .as_configured = true};
}

settings::StackConfig With(settings::StackConfig config, const Gains& gains) {
  if (gains.as_configured) return config;
  settings::PressureSection& pressure = config.pressure;
  pressure.reference_feedforward = true;
  pressure.reference_feedforward_V_psi.reset();
  pressure.arm_speed_feedforward = true;
  if (pressure.k_p) {
    try {
      const pressure_ctrl::PressureGains derived = pressure_ctrl::DerivePressureGains(
          config.model.description.parameters, 0, gains.natural_frequency, gains.damping_ratio, 2,
          model::DifferencesOf(config.model.description));
      pressure.k_p = Rounded(derived.k_p);
      pressure.k_v = Rounded(derived.k_v);
    } catch (const std::invalid_argument& error) {
      throw InputError(config.file + ": pressure: " + error.what());
    }
  } else {
    pressure.natural_frequency_rad_s = Rounded(gains.natural_frequency);
    pressure.damping_ratio = Rounded(gains.damping_ratio);
  }
  config.position.c1 = Rounded(gains.c1);
  config.position.c2 = Rounded(gains.c2);
  config.position.derivative_on_error = false;
  config.position.braking_rad_s2.reset();
  if (std::isfinite(gains.deceleration)) config.position.braking_rad_s2 = Rounded(gains.deceleration);
  return config;
}

std::vector<std::pair<std::string, std::string>> GainKeys(const settings::StackConfig& config) {
  const settings::PressureSection& pressure = config.pressure;
  std::vector<std::pair<std::string, std::string>> keys;
  const auto add = [&](const char* key, double value) { keys.emplace_back(key, ShortestNumber(value)); };
  if (pressure.k_p) {
    add("pressure.k_p", *pressure.k_p);
    add("pressure.k_v", pressure.k_v.value_or(0));
  } else {
    add("pressure.natural_frequency_rad_s", pressure.natural_frequency_rad_s.value_or(0));
    add("pressure.damping_ratio", pressure.damping_ratio.value_or(0));
  }
  if (pressure.reference_feedforward_V_psi) {
    add("pressure.reference_feedforward", *pressure.reference_feedforward_V_psi);
  } else {
    keys.emplace_back("pressure.reference_feedforward", pressure.reference_feedforward ? "true" : "false");
  }
  keys.emplace_back("pressure.arm_speed_feedforward", pressure.arm_speed_feedforward ? "true" : "false");
  add("position.sample_interval_s", config.position.sample_interval_s);
  add("position.c1", config.position.c1);
  add("position.c2", config.position.c2);
  keys.emplace_back("position.derivative",
                    config.position.derivative_on_error ? "\"error\"" : "\"measurement\"");
  if (config.position.braking_rad_s2) add("position.braking", *config.position.braking_rad_s2);
  return keys;
}

}  // namespace hydro::tune
