#include "firmware/sensors.h"

#include "firmware/law.h"

void hydro_sensors_begin(struct hydro_sensors* sensors) {
  *sensors = (struct hydro_sensors){0};
  hydro_sensors_unknown(sensors, 0);
}

void hydro_sensors_unknown(struct hydro_sensors* sensors, uint32_t elapsed_ticks) {
  sensors->unread_ticks += elapsed_ticks;
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) sensors->sensor[i].value = HYDRO_NOT_A_NUMBER;
}

/* Follows a counter of up to 32 bits that wraps. Its first reading counts as signed: a reading just below
 * the wrap means just below zero. After a move of a quarter of its range or more, the direction is
 * uncertain. */
static void follow(struct hydro_sensor* sensor, uint8_t bits, uint32_t reading) {
  const uint32_t half = UINT32_C(1) << (bits - 1);
  const uint32_t mask = half - 1 + half;
  const uint32_t ahead = (reading - (uint32_t)sensor->count) & mask;
  /* This extends the sign by hand: C leaves a shift of a negative number to the compiler. */
  const int64_t moved = ahead >= half ? (int64_t)ahead - (int64_t)mask - 1 : (int64_t)ahead;
  sensor->moved = sensor->started ? (int32_t)moved : 0;
  const uint32_t count = (uint32_t)sensor->count + (uint32_t)(moved & INT64_C(0xffffffff));
  union {
    uint32_t bits;
    int32_t number;
  } pun = {.bits = count};
  sensor->count = pun.number;
  const int64_t quarter = (int64_t)(half / 2);
  if (sensor->started && (moved >= quarter || moved <= -quarter)) sensor->lost = true;
}

static bool analog_is_credible(const struct hydro_sensor_settings* settings,
                               const struct hydro_board_facts* facts, float volts) {
  const bool low =
      hydro_is_finite(settings->minimum_V) ? volts < settings->minimum_V : volts <= facts->analog_min_V;
  const bool high =
      hydro_is_finite(settings->maximum_V) ? volts > settings->maximum_V : volts >= facts->analog_max_V;
  return hydro_is_finite(volts) && !low && !high;
}

/* Takes the reading of an analog input or a counter into `unfiltered` and `rate`; returns false when it is
 * not credible. */
static bool read_channel(struct hydro_sensor* sensor, const struct hydro_sensor_settings* settings,
                         const struct hydro_board_facts* facts, const struct hydro_readings* readings,
                         float per_second) {
  if (settings->kind == HYDRO_SENSOR_COUNTER) {
    follow(sensor, settings->counter_bits, readings->counter[settings->channel]);
    sensor->unfiltered = settings->scale * (float)sensor->count + settings->offset;
    sensor->rate = settings->scale * (float)sensor->moved * per_second;
    return !sensor->lost;
  }
  const float volts = readings->analog_V[settings->channel];
  if (!analog_is_credible(settings, facts, volts)) return false;
  const float now = settings->scale * volts + settings->offset;
  sensor->rate = sensor->started ? (now - sensor->unfiltered) * per_second : 0.0f;
  sensor->unfiltered = now;
  return true;
}

static void judge(struct hydro_sensor* sensor, bool good) {
  if (!good) {
    sensor->good_readings = 0;
    sensor->fault = true;
  } else if (sensor->good_readings < HYDRO_GOOD_READINGS) {
    ++sensor->good_readings;
  }
  if (sensor->good_readings == HYDRO_GOOD_READINGS) sensor->fault = false;
}

static void read_sensor(struct hydro_sensor* sensor, const struct hydro_sensor* angle,
                        const struct hydro_sensor_settings* settings, const struct hydro_board_facts* facts,
                        const struct hydro_readings* readings, float per_second) {
  if (settings->kind == HYDRO_SENSOR_NONE) return;
  bool good = false;
  if (settings->kind == HYDRO_SENSOR_RATE) {
    good = hydro_is_finite(angle->value); /* a fault, if there is one, belongs to the angle */
    sensor->unfiltered = angle->rate;
  } else {
    good = read_channel(sensor, settings, facts, readings, per_second);
    judge(sensor, good);
    sensor->started = good;
  }
  /* After a reading that was not credible, the low pass starts again at the first credible one. */
  if (!good) {
    sensor->value = HYDRO_NOT_A_NUMBER;
  } else if (hydro_is_finite(sensor->value) && settings->low_pass_share < 1.0f) {
    sensor->value += settings->low_pass_share * (sensor->unfiltered - sensor->value);
  } else {
    sensor->value = sensor->unfiltered;
  }
}

void hydro_sensors_read(struct hydro_sensors* sensors, const struct hydro_settings* settings,
                        const struct hydro_board_facts* facts, const struct hydro_readings* readings) {
  const float ticks = (float)(sensors->unread_ticks + readings->elapsed_ticks);
  const float per_second = (float)facts->tick_rate_hz / (ticks > 0.0f ? ticks : 1.0f);
  sensors->unread_ticks = 0;
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) {
    const struct hydro_sensor* angle = &sensors->sensor[i > 0 ? i - 1 : 0];
    read_sensor(&sensors->sensor[i], angle, &settings->sensors[i], facts, readings, per_second);
  }
}

uint8_t hydro_sensors_faults(const struct hydro_sensors* sensors) {
  uint8_t faults = 0;
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) {
    if (sensors->sensor[i].fault) faults = (uint8_t)(faults | (1u << i));
  }
  return faults;
}
