/* The codec of frames.h. A function describes each body once by visiting its fields in order. The same
 * visit writes and reads the fields, so that writing and reading cannot differ. */
#include "firmware/frames.h"

_Static_assert(sizeof(float) == 4, "floats of 32 bits");

/* The position of a visit, and its direction. */
struct cursor {
  uint8_t* bytes;
  size_t at;
  bool writes;
};

static uint64_t visit_bytes(struct cursor* cursor, uint64_t value, size_t count) {
  uint64_t read = 0;
  for (size_t i = 0; i < count; ++i) {
    uint8_t* byte = &cursor->bytes[cursor->at + i];
    if (cursor->writes) *byte = (uint8_t)(value >> (8 * i));
    read |= (uint64_t)*byte << (8 * i);
  }
  cursor->at += count;
  return read;
}

static void visit_u8(struct cursor* cursor, uint8_t* value) {
  *value = (uint8_t)visit_bytes(cursor, *value, 1);
}
static void visit_u16(struct cursor* cursor, uint16_t* value) {
  *value = (uint16_t)visit_bytes(cursor, *value, 2);
}
static void visit_u32(struct cursor* cursor, uint32_t* value) {
  *value = (uint32_t)visit_bytes(cursor, *value, 4);
}
static void visit_u64(struct cursor* cursor, uint64_t* value) { *value = visit_bytes(cursor, *value, 8); }

static void visit_i32(struct cursor* cursor, int32_t* value) {
  union {
    uint32_t bits;
    int32_t number;
  } pun = {.number = *value};
  visit_u32(cursor, &pun.bits);
  *value = pun.number;
}

static void visit_i64(struct cursor* cursor, int64_t* value) {
  union {
    uint64_t bits;
    int64_t number;
  } pun = {.number = *value};
  visit_u64(cursor, &pun.bits);
  *value = pun.number;
}

static void visit_f32(struct cursor* cursor, float* value) {
  union {
    uint32_t bits;
    float number;
  } pun = {.number = *value};
  visit_u32(cursor, &pun.bits);
  *value = pun.number;
}

static void visit_sensor(struct cursor* cursor, struct hydro_sensor_settings* sensor) {
  visit_u8(cursor, &sensor->kind);
  visit_u8(cursor, &sensor->channel);
  visit_u8(cursor, &sensor->counter_bits);
  visit_bytes(cursor, 0, 1);
  visit_f32(cursor, &sensor->scale);
  visit_f32(cursor, &sensor->offset);
  visit_f32(cursor, &sensor->low_pass_share);
  visit_f32(cursor, &sensor->minimum_V);
  visit_f32(cursor, &sensor->maximum_V);
}

static void visit_settings(struct cursor* cursor, struct hydro_settings* settings) {
  visit_u8(cursor, &settings->mode);
  visit_bytes(cursor, 0, 1);
  visit_u16(cursor, &settings->sample_interval_ticks);
  visit_u32(cursor, &settings->watchdog_ticks);
  visit_u32(cursor, &settings->transfer_ticks);
  visit_f32(cursor, &settings->voltage_limit);
  visit_f32(cursor, &settings->pressure_limit);
  visit_f32(cursor, &settings->motor_speed_limit);
  visit_f32(cursor, &settings->arm_angle_limit);
  visit_f32(cursor, &settings->reference_limit);
  visit_f32(cursor, &settings->output_scale);
  visit_f32(cursor, &settings->output_offset);
  visit_f32(cursor, &settings->read_back_tolerance);
  visit_bytes(cursor, 0, 4);
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) visit_sensor(cursor, &settings->sensors[i]);
}

static void visit_arm(struct cursor* cursor, struct hydro_arm* arm) {
  visit_u32(cursor, &arm->fingerprint);
  visit_u32(cursor, &arm->trips);
}

static void visit_voltage(struct cursor* cursor, struct hydro_command* command) {
  visit_u32(cursor, &command->fingerprint);
  visit_i64(cursor, &command->host_tick);
  visit_f32(cursor, &command->voltage);
}

static void visit_pressure(struct cursor* cursor, struct hydro_command* command) {
  visit_u32(cursor, &command->fingerprint);
  visit_i64(cursor, &command->host_tick);
  visit_f32(cursor, &command->pressure_ref);
  visit_f32(cursor, &command->gains.k_p);
  visit_f32(cursor, &command->gains.k_v);
  visit_f32(cursor, &command->gains.reference_feedforward);
  visit_f32(cursor, &command->gains.arm_speed_ratio);
}

static void visit_identity(struct cursor* cursor, struct hydro_identity* identity) {
  visit_u8(cursor, &identity->state);
  visit_u8(cursor, &identity->modes);
  for (size_t i = 0; i < 3; ++i) visit_u16(cursor, &identity->firmware[i]);
  visit_u32(cursor, &identity->boot);
  visit_u32(cursor, &identity->tick_rate_hz);
  visit_u64(cursor, &identity->tick);
  visit_u32(cursor, &identity->session_in_charge);
  visit_u32(cursor, &identity->fingerprint);
  visit_u8(cursor, &identity->analog_inputs);
  visit_u8(cursor, &identity->counters);
  visit_bytes(cursor, 0, 2);
  visit_f32(cursor, &identity->output_min_V);
  visit_f32(cursor, &identity->output_max_V);
  for (size_t i = 0; i < HYDRO_BOARD_NAME_BYTES; ++i) {
    identity->board[i] = (char)visit_bytes(cursor, (uint8_t)identity->board[i], 1);
  }
}

static void visit_held(struct cursor* cursor, struct hydro_settings_held* held) {
  visit_u8(cursor, &held->refused);
  visit_u8(cursor, &held->refused_part);
  visit_bytes(cursor, 0, 2);
  visit_u32(cursor, &held->fingerprint);
  visit_settings(cursor, &held->settings);
}

static void visit_sample(struct cursor* cursor, struct hydro_sample* sample) {
  visit_u64(cursor, &sample->tick);
  visit_u8(cursor, &sample->state);
  visit_u8(cursor, &sample->source);
  visit_u8(cursor, &sample->saturated);
  visit_u8(cursor, &sample->sensor_faults);
  visit_u16(cursor, &sample->faults_present);
  visit_u16(cursor, &sample->faults_latched);
  visit_u32(cursor, &sample->trips);
  visit_u32(cursor, &sample->command_sequence);
  visit_i64(cursor, &sample->host_tick);
  visit_u32(cursor, &sample->command_age);
  for (size_t i = 0; i < HYDRO_SENSORS; ++i) visit_f32(cursor, &sample->value[i]);
  visit_i32(cursor, &sample->motor_count);
  visit_i32(cursor, &sample->arm_count);
  visit_f32(cursor, &sample->voltage);
  visit_f32(cursor, &sample->read_back);
  visit_f32(cursor, &sample->pressure_ref);
  visit_f32(cursor, &sample->transfer);
  visit_u16(cursor, &sample->frames_bad);
  visit_u16(cursor, &sample->frames_refused);
}

static void visit_output(struct cursor* cursor, struct hydro_output* output) {
  visit_u64(cursor, &output->tick);
  visit_f32(cursor, &output->volts);
}

static void visit_converters(struct cursor* cursor, struct hydro_converters* converters) {
  visit_u64(cursor, &converters->tick);
  for (size_t i = 0; i < HYDRO_ANALOG_INPUTS; ++i) visit_f32(cursor, &converters->analog_V[i]);
  for (size_t i = 0; i < HYDRO_COUNTERS; ++i) visit_u32(cursor, &converters->counter[i]);
  visit_f32(cursor, &converters->read_back_V);
  visit_u8(cursor, &converters->interlock);
  visit_bytes(cursor, 0, 3);
}

/* Visits the body of the frame's kind. Returns false when there is no such kind. */
static bool visit_body(struct cursor* cursor, struct hydro_frame* frame) {
  switch (frame->kind) {
    case HYDRO_HELLO:
    case HYDRO_ZERO:
      return true;
    case HYDRO_SETTINGS:
      visit_settings(cursor, &frame->body.settings);
      return true;
    case HYDRO_ARM:
      visit_arm(cursor, &frame->body.arm);
      return true;
    case HYDRO_VOLTAGE:
      visit_voltage(cursor, &frame->body.command);
      return true;
    case HYDRO_PRESSURE:
      visit_pressure(cursor, &frame->body.command);
      return true;
    case HYDRO_IDENTITY:
      visit_identity(cursor, &frame->body.identity);
      return true;
    case HYDRO_SETTINGS_HELD:
      visit_held(cursor, &frame->body.held);
      return true;
    case HYDRO_SAMPLE:
      visit_sample(cursor, &frame->body.sample);
      return true;
    case HYDRO_OUTPUT:
      visit_output(cursor, &frame->body.output);
      return true;
    case HYDRO_CONVERTERS:
      visit_converters(cursor, &frame->body.converters);
      return true;
    default:
      return false;
  }
}

/* Visits all but the checksum. Returns false when there is no such kind. */
static bool visit_frame(struct cursor* cursor, struct hydro_frame* frame) {
  visit_u8(cursor, &frame->protocol);
  visit_u8(cursor, &frame->kind);
  visit_bytes(cursor, 0, 2);
  visit_u32(cursor, &frame->session);
  visit_u32(cursor, &frame->sequence);
  return visit_body(cursor, frame);
}

uint32_t hydro_crc32(uint32_t crc, const uint8_t* bytes, size_t count) {
  /* Takes four bits at a time: a table of 64 bytes, fast enough for 5 kHz on a small microcontroller. */
  static const uint32_t table[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
                                     0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                     0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
  crc = ~crc;
  for (size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    crc = (crc >> 4) ^ table[crc & 15];
    crc = (crc >> 4) ^ table[crc & 15];
  }
  return ~crc;
}

uint32_t hydro_fingerprint(const struct hydro_settings* settings) {
  uint8_t bytes[1 + HYDRO_SETTINGS_BYTES] = {HYDRO_PROTOCOL};
  struct hydro_settings copy = *settings;
  struct cursor cursor = {.bytes = bytes, .at = 1, .writes = true};
  visit_settings(&cursor, &copy);
  const uint32_t fingerprint = hydro_crc32(0, bytes, cursor.at);
  return fingerprint == 0 ? 1 : fingerprint;
}

size_t hydro_encode(const struct hydro_frame* frame, uint8_t wire[HYDRO_WIRE_MAX]) {
  struct hydro_frame copy = *frame;
  copy.protocol = HYDRO_PROTOCOL;
  struct cursor cursor = {.bytes = &wire[2], .at = 0, .writes = true};
  if (!visit_frame(&cursor, &copy)) return 0;
  uint32_t crc = hydro_crc32(0, cursor.bytes, cursor.at);
  visit_u32(&cursor, &crc);
  /* Consistent overhead byte stuffing: from the code byte on, each zero becomes the distance to the next. */
  wire[0] = 0;
  size_t code_at = 1;
  const size_t end = 2 + cursor.at;
  for (size_t i = 2; i < end; ++i) {
    if (wire[i] != 0) continue;
    wire[code_at] = (uint8_t)(i - code_at);
    code_at = i;
  }
  wire[code_at] = (uint8_t)(end - code_at);
  wire[end] = 0;
  return end + 1;
}

/* Undoes the stuffing in place; returns false when the distances do not lead to the end. */
static bool unstuff(uint8_t* bytes, size_t count) {
  size_t code_at = 0;
  for (size_t i = 0; i < count; ++i) {
    if (i != code_at) continue;
    code_at = i + bytes[i];
    bytes[i] = 0;
  }
  return code_at == count;
}

/* A later protocol may append to a hello and to an identity but change neither: each side must learn what
 * the other is. */
static bool is_greeting(const struct hydro_frame* frame, size_t known, size_t count) {
  const bool greets = frame->kind == HYDRO_HELLO || frame->kind == HYDRO_IDENTITY;
  return greets && frame->protocol != HYDRO_PROTOCOL && known <= count;
}

/* Returns true when the collected bytes are a frame, which is now in `frame`. */
static bool read_frame(struct hydro_receiver* receiver, struct hydro_frame* frame) {
  if (receiver->count < 1 + HYDRO_HEADER_BYTES + HYDRO_CRC_BYTES) return false;
  if (!unstuff(receiver->bytes, receiver->count)) return false;
  const size_t checked = receiver->count - 1 - HYDRO_CRC_BYTES;
  struct cursor cursor = {.bytes = &receiver->bytes[1], .at = checked, .writes = false};
  uint32_t crc = 0;
  visit_u32(&cursor, &crc);
  if (crc != hydro_crc32(0, cursor.bytes, checked)) return false;
  /* A body is never read beyond the receiver's bytes: no kind is longer than HYDRO_FRAME_MAX. */
  struct hydro_frame found = {0};
  cursor.at = 0;
  if (!visit_frame(&cursor, &found)) return false;
  const bool ours = found.protocol == HYDRO_PROTOCOL && cursor.at == checked;
  if (!ours && !is_greeting(&found, cursor.at, checked)) return false;
  *frame = found;
  return true;
}

void hydro_receive_anew(struct hydro_receiver* receiver) {
  receiver->count = 0;
  receiver->overflow = false;
}

bool hydro_receive(struct hydro_receiver* receiver, uint8_t byte, struct hydro_frame* frame) {
  if (byte != 0) {
    receiver->overflow = receiver->overflow || receiver->count == sizeof receiver->bytes;
    if (!receiver->overflow) receiver->bytes[receiver->count++] = byte;
    return false;
  }
  const bool something = receiver->count > 0;
  const bool good = something && !receiver->overflow && read_frame(receiver, frame);
  if (something && !good) ++receiver->bad;
  hydro_receive_anew(receiver);
  return good;
}
