#include "firmware/settings.h"

#include "firmware/law.h"

static bool is_limit(float limit) { return limit > 0.0f; } /* +infinity: no limit; false for NaN */

static bool limits_are_good(const struct hydro_settings* settings) {
  return is_limit(settings->voltage_limit) && is_limit(settings->pressure_limit) &&
         is_limit(settings->motor_speed_limit) && is_limit(settings->arm_angle_limit) &&
         is_limit(settings->reference_limit);
}

static bool output_is_good(const struct hydro_settings* settings) {
  return hydro_is_finite(settings->output_scale) && settings->output_scale != 0.0f &&
         hydro_is_finite(settings->output_offset) && hydro_is_finite(settings->read_back_tolerance) &&
         settings->read_back_tolerance >= 0.0f;
}

static bool is_angle(size_t index) { return index == HYDRO_MOTOR_ANGLE || index == HYDRO_ARM_ANGLE; }
static bool is_speed(size_t index) { return index == HYDRO_MOTOR_SPEED || index == HYDRO_ARM_SPEED; }

static bool sensor_is_good(const struct hydro_settings* settings, size_t index,
                           const struct hydro_board_facts* facts) {
  const struct hydro_sensor_settings* sensor = &settings->sensors[index];
  const bool scaled = hydro_is_finite(sensor->scale) && hydro_is_finite(sensor->offset);
  const bool filtered = sensor->low_pass_share > 0.0f && sensor->low_pass_share <= 1.0f;
  /* Infinite ends are allowed; NaN is not, and neither are ends in the wrong order. */
  const bool ranged = sensor->minimum_V < sensor->maximum_V;
  switch (sensor->kind) {
    case HYDRO_SENSOR_NONE:
      return true;
    case HYDRO_SENSOR_ANALOG:
      return scaled && filtered && ranged && sensor->channel < facts->analog_inputs;
    case HYDRO_SENSOR_COUNTER:
      return scaled && filtered && is_angle(index) && sensor->channel < facts->counters &&
             sensor->counter_bits >= 8 && sensor->counter_bits <= 32;
    case HYDRO_SENSOR_RATE:
      return filtered && is_speed(index) && settings->sensors[index - 1].kind != HYDRO_SENSOR_NONE;
    default:
      return false;
  }
}

static bool measured(const struct hydro_settings* settings, enum hydro_sensor_index index) {
  return settings->sensors[index].kind != HYDRO_SENSOR_NONE;
}

/* Whether every signal that the limits judge or the law needs is measured. */
static bool sensors_suffice(const struct hydro_settings* settings) {
  const bool loop = settings->mode == HYDRO_LOOP_ON_DEVICE;
  const bool pressures = measured(settings, HYDRO_P1) && measured(settings, HYDRO_P2);
  if ((loop || hydro_is_finite(settings->pressure_limit)) && !pressures) return false;
  const bool speed = measured(settings, HYDRO_MOTOR_SPEED);
  if ((loop || hydro_is_finite(settings->motor_speed_limit)) && !speed) return false;
  return !hydro_is_finite(settings->arm_angle_limit) || measured(settings, HYDRO_ARM_ANGLE);
}

struct hydro_voltage_range hydro_reachable_voltages(const struct hydro_settings* settings,
                                                    const struct hydro_board_facts* facts) {
  const float a = settings->output_scale * facts->output_min_V + settings->output_offset;
  const float b = settings->output_scale * facts->output_max_V + settings->output_offset;
  const float limit = settings->voltage_limit;
  struct hydro_voltage_range range = {.low = a < b ? a : b, .high = a < b ? b : a};
  if (range.low < -limit) range.low = -limit;
  if (range.high > limit) range.high = limit;
  return range;
}

enum hydro_refusal hydro_check_settings(const struct hydro_settings* settings,
                                        const struct hydro_board_facts* facts, uint8_t* part) {
  *part = 0;
  if (settings->mode != HYDRO_REMOTE_IO && settings->mode != HYDRO_LOOP_ON_DEVICE) return HYDRO_REFUSED_MODE;
  const uint32_t second = facts->tick_rate_hz;
  if (settings->sample_interval_ticks < 1 || settings->sample_interval_ticks > second)
    return HYDRO_REFUSED_INTERVAL;
  if (settings->watchdog_ticks < 1 || settings->watchdog_ticks > second) return HYDRO_REFUSED_WATCHDOG;
  if (!limits_are_good(settings)) return HYDRO_REFUSED_LIMIT;
  if (!output_is_good(settings)) return HYDRO_REFUSED_OUTPUT;
  const struct hydro_voltage_range range = hydro_reachable_voltages(settings, facts);
  if (!(range.low <= 0.0f && range.high >= 0.0f)) return HYDRO_REFUSED_ZERO;
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) {
    if (sensor_is_good(settings, i, facts)) continue;
    *part = (uint8_t)i;
    return HYDRO_REFUSED_SENSOR;
  }
  return sensors_suffice(settings) ? HYDRO_TAKEN : HYDRO_REFUSED_MISSING;
}
