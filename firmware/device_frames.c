/* How a device handles the frames that it receives. */
#include "firmware/device_frames.h"

void hydro_device_identify(const struct hydro_device* device, struct hydro_frame* frame) {
  frame->kind = HYDRO_IDENTITY;
  struct hydro_identity* identity = &frame->body.identity;
  *identity =
      (struct hydro_identity){.state = device->state,
                              .modes = 3,
                              .firmware = {HYDRO_FIRMWARE_MAJOR, HYDRO_FIRMWARE_MINOR, HYDRO_FIRMWARE_PATCH},
                              .boot = device->facts.boot,
                              .tick_rate_hz = device->facts.tick_rate_hz,
                              .tick = device->tick,
                              .session_in_charge = device->session,
                              .fingerprint = device->fingerprint,
                              .analog_inputs = device->facts.analog_inputs,
                              .counters = device->facts.counters,
                              .output_min_V = device->facts.output_min_V,
                              .output_max_V = device->facts.output_max_V};
  bool ended = false;
  for (size_t i = 0; i < HYDRO_BOARD_NAME_BYTES; ++i) {
    ended = ended || device->facts.name[i] == '\0';
    identity->board[i] = ended ? '\0' : device->facts.name[i];
  }
}

/* Another computer may take over from one that has gone silent, never from one that drives or is heard. */
static bool session_is_free(const struct hydro_device* device) {
  if (device->session == 0) return true;
  return device->state != HYDRO_ARMED && device->heard_ticks >= device->facts.tick_rate_hz / 4;
}

/* Returns true when this session is in charge now. */
static bool take_hello(struct hydro_device* device, const struct hydro_frame* frame) {
  device->owes_identity = true;
  if (frame->protocol != HYDRO_PROTOCOL || frame->session == 0) return false;
  if (frame->session != device->session) {
    if (!session_is_free(device)) return false;
    hydro_device_leave_armed(device, HYDRO_IDLE);
    device->session = frame->session;
    device->newest = frame->sequence;
    device->fingerprint = 0;
    device->settings = (struct hydro_settings){0};
    device->faults_present = device->faults_momentary = device->faults_latched = 0;
    device->owes_held = device->owes_sample = false;
  } else if (!hydro_is_newer(frame->sequence, device->newest)) {
    return false;
  }
  device->newest = frame->sequence;
  device->heard_ticks = 0;
  return true;
}

static void take_settings(struct hydro_device* device, const struct hydro_settings* settings) {
  device->owes_held = true;
  device->refused_part = 0;
  device->refused = HYDRO_REFUSED_ARMED;
  if (device->state == HYDRO_ARMED) return;
  device->refused = (uint8_t)hydro_check_settings(settings, &device->facts, &device->refused_part);
  if (device->refused != HYDRO_TAKEN) return;
  device->settings = *settings;
  device->fingerprint = hydro_fingerprint(settings);
  device->state = HYDRO_READY;
  device->zero_volts = hydro_clamp(-settings->output_offset / settings->output_scale,
                                   device->facts.output_min_V, device->facts.output_max_V);
  device->faults_present = device->faults_momentary = device->faults_latched = 0;
  device->read_back_differs = 0;
  device->acted_by_law = false;
  device->sample_in_ticks = 0;
  hydro_sensors_begin(&device->sensors);
}

/* Returns false when the command was made for other settings. */
static bool fits(struct hydro_device* device, uint32_t fingerprint) {
  if (device->fingerprint != 0 && fingerprint == device->fingerprint) return true;
  ++device->frames_refused;
  hydro_device_trip(device, HYDRO_FAULT_FINGERPRINT);
  return false;
}

static void take_arm(struct hydro_device* device, const struct hydro_arm* arm) {
  if (!fits(device, arm->fingerprint)) return;
  const bool zero = device->state == HYDRO_READY || device->state == HYDRO_TRIPPED;
  if (!zero || arm->trips != device->trips || device->faults_present != 0) return;
  device->state = HYDRO_ARMED;
  device->faults_latched = 0;
  device->obeyed = (struct hydro_obeyed){.fresh = true};
}

static bool command_is_good(const struct hydro_device* device, const struct hydro_frame* frame) {
  const struct hydro_command* command = &frame->body.command;
  if (frame->kind == HYDRO_VOLTAGE) return hydro_is_finite(command->voltage);
  const float limit = device->settings.reference_limit;
  return device->settings.mode == HYDRO_LOOP_ON_DEVICE && hydro_is_finite(command->pressure_ref) &&
         command->pressure_ref <= limit && command->pressure_ref >= -limit &&
         hydro_finite_gains(&command->gains);
}

static void take_command(struct hydro_device* device, const struct hydro_frame* frame) {
  if (!fits(device, frame->body.command.fingerprint)) return;
  if (!command_is_good(device, frame)) {
    hydro_device_trip(device, HYDRO_FAULT_COMMAND);
    return;
  }
  if (device->state != HYDRO_ARMED) return;
  device->obeyed =
      (struct hydro_obeyed){.any = true,
                            .fresh = true,
                            .source = frame->kind == HYDRO_VOLTAGE ? HYDRO_SOURCE_VOLTAGE : HYDRO_SOURCE_LAW,
                            .sequence = frame->sequence,
                            .age_ticks = device->obeyed.age_ticks, /* for the watchdog, of the one before */
                            .command = frame->body.command};
}

static void take_zero(struct hydro_device* device) {
  if (device->state == HYDRO_ARMED) hydro_device_leave_armed(device, HYDRO_READY);
}

static bool is_for_devices(uint8_t kind) {
  return kind == HYDRO_SETTINGS || kind == HYDRO_ARM || kind == HYDRO_VOLTAGE || kind == HYDRO_PRESSURE;
}

/* Takes a whole frame; returns true in the same cases as hydro_device_receive(). */
static bool take_frame(struct hydro_device* device, const struct hydro_frame* frame) {
  if (frame->kind == HYDRO_HELLO) {
    const bool taken = take_hello(device, frame);
    if (!taken) ++device->frames_refused;
    return taken;
  }
  /* Any sender may ask for zero volts, at any time. */
  if (frame->kind == HYDRO_ZERO) take_zero(device);
  const bool ours = device->session != 0 && frame->session == device->session;
  const bool known = is_for_devices(frame->kind) || frame->kind == HYDRO_ZERO;
  if (!ours || !known || !hydro_is_newer(frame->sequence, device->newest)) {
    ++device->frames_refused;
    return false;
  }
  device->newest = frame->sequence;
  device->heard_ticks = 0;
  if (frame->kind == HYDRO_SETTINGS) take_settings(device, &frame->body.settings);
  if (frame->kind == HYDRO_ARM) take_arm(device, &frame->body.arm);
  if (frame->kind == HYDRO_VOLTAGE || frame->kind == HYDRO_PRESSURE) take_command(device, frame);
  return false;
}

bool hydro_device_receive(struct hydro_device* device, uint8_t byte) {
  struct hydro_frame frame;
  return hydro_receive(&device->receiver, byte, &frame) && take_frame(device, &frame);
}
