/* What a device does in each tick, and what it sends. device_frames.c handles the frames that it receives. */
#include "firmware/device.h"

#include "firmware/device_frames.h"

void hydro_device_begin(struct hydro_device* device, const struct hydro_board_facts* facts) {
  *device = (struct hydro_device){.facts = *facts, .state = HYDRO_IDLE};
  hydro_sensors_begin(&device->sensors);
}

void hydro_device_leave_armed(struct hydro_device* device, enum hydro_state state) {
  if (device->state == HYDRO_ARMED) ++device->trips;
  device->state = (uint8_t)state;
  device->obeyed = (struct hydro_obeyed){0};
}

void hydro_device_trip(struct hydro_device* device, uint16_t faults) {
  device->faults_momentary |= faults;
  if (device->state != HYDRO_ARMED) return;
  device->faults_latched |= faults;
  hydro_device_leave_armed(device, HYDRO_TRIPPED);
}

/* value| > limit; false for NaN, which the sensor's fault covers. */
static bool exceeds(float value, float limit) { return value > limit || value < -limit; }

/* The lasting faults, as this tick finds them. */
static uint16_t present_faults(const struct hydro_device* device, const struct hydro_readings* readings) {
  const struct hydro_settings* settings = &device->settings;
  const struct hydro_sensor* sensor = device->sensors.sensor;
  unsigned faults = 0;
  if (sensor[HYDRO_P1].value > settings->pressure_limit ||
      sensor[HYDRO_P2].value > settings->pressure_limit) {
    faults |= HYDRO_FAULT_PRESSURE;
  }
  if (exceeds(sensor[HYDRO_MOTOR_SPEED].value, settings->motor_speed_limit))
    faults |= HYDRO_FAULT_MOTOR_SPEED;
  if (exceeds(sensor[HYDRO_ARM_ANGLE].value, settings->arm_angle_limit)) faults |= HYDRO_FAULT_ARM_ANGLE;
  if (hydro_sensors_faults(&device->sensors) != 0) faults |= HYDRO_FAULT_SENSOR;
  if (device->read_back_differs >= 2) faults |= HYDRO_FAULT_READ_BACK;
  if (!readings->answered) faults |= HYDRO_FAULT_CONVERTER;
  if (readings->answered && !readings->interlock_closed) faults |= HYDRO_FAULT_INTERLOCK;
  return (uint16_t)faults;
}

/* Compares the output's voltage with the written one; a difference for one tick may be the converter
 * settling. */
static void judge_read_back(struct hydro_device* device, const struct hydro_readings* readings) {
  const float tolerance = device->settings.read_back_tolerance;
  if (tolerance == 0.0f || !hydro_is_finite(readings->read_back_V)) return;
  const bool differs = exceeds(readings->read_back_V - device->written_volts, tolerance);
  if (!differs) device->read_back_differs = 0;
  if (differs && device->read_back_differs < 2) ++device->read_back_differs;
}

static void read_machine(struct hydro_device* device, const struct hydro_readings* readings) {
  if (readings->answered) {
    hydro_sensors_read(&device->sensors, &device->settings, &device->facts, readings);
    judge_read_back(device, readings);
  } else {
    hydro_sensors_unknown(&device->sensors, readings->elapsed_ticks);
  }
  device->faults_present = present_faults(device, readings);
}

/* Counts the ticks since the newest command, and trips when the device must not go on. A command that comes
 * now does not excuse the ticks that were missed before: in them the one before grew too old, and this one
 * may have waited as long. */
static void watch(struct hydro_device* device, const struct hydro_readings* readings) {
  struct hydro_obeyed* obeyed = &device->obeyed;
  const uint32_t elapsed = readings->elapsed_ticks;
  const uint32_t missed = elapsed > 0 ? elapsed - 1 : 0;
  const uint32_t oldest = obeyed->age_ticks + (obeyed->fresh ? missed : elapsed);
  obeyed->age_ticks = obeyed->fresh ? 0 : oldest;
  obeyed->fresh = false;
  if (device->heard_ticks < device->facts.tick_rate_hz) device->heard_ticks += elapsed;
  if (device->state == HYDRO_ARMED && oldest >= device->settings.watchdog_ticks) {
    hydro_device_trip(device, HYDRO_FAULT_WATCHDOG);
  }
  if (readings->overrun) hydro_device_trip(device, HYDRO_FAULT_OVERRUN);
  if (device->faults_present != 0) hydro_device_trip(device, device->faults_present);
}

/* Eq. (16). A change of gains while it acts leaves the voltage where it was; the difference fades out. */
static float act_by_law(struct hydro_device* device, uint32_t elapsed_ticks) {
  const struct hydro_sensor* sensor = device->sensors.sensor;
  const struct hydro_command* command = &device->obeyed.command;
  const struct hydro_law_input input = {.pressure_ref = command->pressure_ref,
                                        .p1 = sensor[HYDRO_P1].value,
                                        .p2 = sensor[HYDRO_P2].value,
                                        .motor_speed = sensor[HYDRO_MOTOR_SPEED].value,
                                        .arm_speed = sensor[HYDRO_ARM_SPEED].value};
  const float voltage = hydro_law(&command->gains, &input);
  if (!device->acted_by_law) device->transfer = (struct hydro_transfer){0};
  hydro_transfer_pass(&device->transfer, elapsed_ticks);
  if (device->acted_by_law && !hydro_same_gains(&device->gains, &command->gains)) {
    const float before = hydro_law(&device->gains, &input) + hydro_transfer_now(&device->transfer);
    hydro_transfer_begin(&device->transfer, before, voltage, device->settings.transfer_ticks);
  }
  device->gains = command->gains;
  device->acted_by_law = true;
  device->sample.transfer = hydro_transfer_now(&device->transfer);
  return voltage + device->sample.transfer;
}

/* Puts this tick's V of eq. (1) into the sample: from the command in force, within the limit and the
 * range. */
static float act(struct hydro_device* device, uint32_t elapsed_ticks) {
  struct hydro_sample* sample = &device->sample;
  sample->source = HYDRO_SOURCE_ZERO;
  sample->saturated = 0;
  sample->voltage = sample->pressure_ref = sample->transfer = 0.0f;
  const struct hydro_obeyed* obeyed = &device->obeyed;
  const bool acts = device->state == HYDRO_ARMED && obeyed->any;
  if (!acts || obeyed->source != HYDRO_SOURCE_LAW) device->acted_by_law = false;
  if (!acts) return device->zero_volts;
  sample->source = obeyed->source;
  float asked = obeyed->command.voltage;
  if (obeyed->source == HYDRO_SOURCE_LAW) {
    sample->pressure_ref = obeyed->command.pressure_ref;
    asked = act_by_law(device, elapsed_ticks);
  }
  /* The sum overflows, or the arm speed is not measured: without a number, no voltage goes out. */
  if (!hydro_is_finite(asked)) {
    hydro_device_trip(device, HYDRO_FAULT_COMMAND);
    sample->source = HYDRO_SOURCE_ZERO;
    sample->pressure_ref = sample->transfer = 0.0f;
    return device->zero_volts;
  }
  const struct hydro_voltage_range range = hydro_reachable_voltages(&device->settings, &device->facts);
  sample->voltage = hydro_clamp(asked, range.low, range.high);
  sample->saturated = sample->voltage != asked;
  const float volts = (sample->voltage - device->settings.output_offset) / device->settings.output_scale;
  return hydro_clamp(volts, device->facts.output_min_V, device->facts.output_max_V);
}

static void fill_sample(struct hydro_device* device, const struct hydro_readings* readings) {
  struct hydro_sample* sample = &device->sample;
  const struct hydro_obeyed* obeyed = &device->obeyed;
  const struct hydro_sensor* sensor = device->sensors.sensor;
  sample->tick = device->tick;
  sample->state = device->state;
  sample->sensor_faults = hydro_sensors_faults(&device->sensors);
  sample->faults_present = device->faults_present | device->faults_momentary;
  sample->faults_latched = device->faults_latched;
  sample->trips = device->trips;
  sample->command_sequence = obeyed->any ? obeyed->sequence : 0;
  sample->host_tick = obeyed->any ? obeyed->command.host_tick : 0;
  sample->command_age = obeyed->any ? obeyed->age_ticks : UINT32_MAX;
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) sample->value[i] = sensor[i].value;
  sample->motor_count = sensor[HYDRO_MOTOR_ANGLE].count;
  sample->arm_count = sensor[HYDRO_ARM_ANGLE].count;
  sample->read_back = device->settings.output_scale * readings->read_back_V + device->settings.output_offset;
  sample->frames_bad = (uint16_t)device->receiver.bad;
  sample->frames_refused = device->frames_refused;
  device->faults_momentary = 0;
}

float hydro_device_tick(struct hydro_device* device, const struct hydro_readings* readings) {
  device->tick += readings->elapsed_ticks;
  if (device->fingerprint == 0) {
    watch(device, readings);
    return device->written_volts = device->zero_volts;
  }
  read_machine(device, readings);
  watch(device, readings);
  device->written_volts = act(device, readings->elapsed_ticks);
  device->sample_in_ticks -=
      readings->elapsed_ticks < device->sample_in_ticks ? readings->elapsed_ticks : device->sample_in_ticks;
  if (device->sample_in_ticks == 0) {
    device->sample_in_ticks = device->settings.sample_interval_ticks;
    fill_sample(device, readings);
    device->owes_sample = true;
  }
  return device->written_volts;
}

size_t hydro_device_send(struct hydro_device* device, uint8_t wire[HYDRO_WIRE_MAX]) {
  struct hydro_frame frame = {.session = device->session, .sequence = device->sent};
  if (device->owes_identity) {
    hydro_device_identify(device, &frame);
    device->owes_identity = false;
  } else if (device->owes_held) {
    frame.kind = HYDRO_SETTINGS_HELD;
    frame.body.held = (struct hydro_settings_held){.refused = device->refused,
                                                   .refused_part = device->refused_part,
                                                   .fingerprint = device->fingerprint,
                                                   .settings = device->settings};
    device->owes_held = false;
  } else if (device->owes_sample) {
    frame.kind = HYDRO_SAMPLE;
    frame.body.sample = device->sample;
    device->owes_sample = false;
  } else {
    return 0;
  }
  ++device->sent;
  return hydro_encode(&frame, wire);
}
