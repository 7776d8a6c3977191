/* The frames between a computer and a front end, and their codec. docs/front_end.md describes every byte.
 *
 * Both sides use one codec: portable C11, compiled into the device and into the programs on the computer.
 * It allocates nothing, keeps no static state, and reads and writes bytes one by one, so that it does not
 * depend on a machine's byte order or alignment. Floats are IEEE 754 of 32 bits. */
#ifndef HYDRO_FIRMWARE_FRAMES_H
#define HYDRO_FIRMWARE_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  HYDRO_PROTOCOL = 1,      /* the first byte of every frame */
  HYDRO_HEADER_BYTES = 12, /* protocol, kind, two zeros, session, sequence */
  HYDRO_CRC_BYTES = 4,     /* at the end of every frame */
  HYDRO_FRAME_MAX = 254,   /* bytes of a frame before stuffing, for which one code byte suffices */
  HYDRO_WIRE_MAX = HYDRO_FRAME_MAX + 3, /* zero, code byte, frame, zero */
  HYDRO_SETTINGS_BYTES = 192,           /* of struct hydro_settings on the wire */
  HYDRO_SENSORS = 6,
  HYDRO_ANALOG_INPUTS = 8,
  HYDRO_COUNTERS = 2,
  HYDRO_BOARD_NAME_BYTES = 16
};

enum hydro_kind {
  /* computer to device */
  HYDRO_HELLO = 0x01,
  HYDRO_SETTINGS = 0x02,
  HYDRO_ARM = 0x03,
  HYDRO_VOLTAGE = 0x04,
  HYDRO_PRESSURE = 0x05,
  HYDRO_ZERO = 0x06,
  /* converter link, of emulated boards only */
  HYDRO_OUTPUT = 0x40,     /* device to simulator */
  HYDRO_CONVERTERS = 0x41, /* simulator to device */
  /* device to computer */
  HYDRO_IDENTITY = 0x81,
  HYDRO_SETTINGS_HELD = 0x82,
  HYDRO_SAMPLE = 0x83
};

enum hydro_state {
  HYDRO_IDLE = 0,   /* no settings; zero volts */
  HYDRO_READY = 1,  /* settings held, not armed; zero volts */
  HYDRO_ARMED = 2,  /* obeys commands */
  HYDRO_TRIPPED = 3 /* zero volts until HYDRO_ARM */
};

enum hydro_mode {
  HYDRO_REMOTE_IO = 1,     /* the computer runs the pressure loop and sends voltages */
  HYDRO_LOOP_ON_DEVICE = 2 /* the device runs eq. (16); the computer sends dp_ref and gains, or voltages */
};

/* Bits of faults_present and faults_latched. */
enum hydro_fault {
  HYDRO_FAULT_WATCHDOG = 1 << 0, /* no valid command for watchdog_ticks */
  HYDRO_FAULT_COMMAND = 1 << 1,  /* a command with a number that is not finite, or dp_ref beyond its limit */
  HYDRO_FAULT_FINGERPRINT = 1 << 2, /* a command made for other settings */
  HYDRO_FAULT_PRESSURE = 1 << 3,    /* p1 or p2 above pressure_limit */
  HYDRO_FAULT_MOTOR_SPEED = 1 << 4, /* |motor speed| above motor_speed_limit */
  HYDRO_FAULT_ARM_ANGLE = 1 << 5,   /* |arm angle| above arm_angle_limit */
  HYDRO_FAULT_SENSOR = 1 << 6,      /* a sensor's reading is not credible: sensor_faults tells which one */
  HYDRO_FAULT_READ_BACK = 1 << 7,   /* the output is not what was written */
  HYDRO_FAULT_CONVERTER = 1 << 8,   /* the board's converters do not answer */
  HYDRO_FAULT_OVERRUN = 1 << 9,     /* a tick took longer than its time */
  HYDRO_FAULT_INTERLOCK = 1 << 10   /* the board's emergency stop or enable input is open */
};

/* The origin of the voltage in a sample. */
enum hydro_source {
  HYDRO_SOURCE_ZERO = 0,
  HYDRO_SOURCE_VOLTAGE = 1, /* HYDRO_VOLTAGE, passed on */
  HYDRO_SOURCE_LAW = 2      /* eq. (16) */
};

enum hydro_sensor_kind {
  HYDRO_SENSOR_NONE = 0,
  HYDRO_SENSOR_ANALOG = 1,
  HYDRO_SENSOR_COUNTER = 2,
  HYDRO_SENSOR_RATE = 3 /* the rate of the angle before it */
};

/* The order of the sensors in settings, and of the bits of sensor_faults. */
enum hydro_sensor_index {
  HYDRO_P1 = 0,
  HYDRO_P2 = 1,
  HYDRO_MOTOR_ANGLE = 2,
  HYDRO_MOTOR_SPEED = 3,
  HYDRO_ARM_ANGLE = 4,
  HYDRO_ARM_SPEED = 5
};

struct hydro_sensor_settings {
  uint8_t kind;         /* enum hydro_sensor_kind */
  uint8_t channel;      /* of the board's analog inputs or counters; 0 for the other kinds */
  uint8_t counter_bits; /* 8 to 32: a counter wraps between 2^counter_bits - 1 and 0; 0 for the other kinds */
  float scale;          /* unit per V, or unit per count */
  float offset;         /* unit */
  float low_pass_share; /* share of a reading that each tick takes over, above 0 to 1; 1: no low pass */
  float minimum_V;      /* an analog reading outside these is not credible; -inf and +inf: */
  float maximum_V;      /* the ends of the converter's range are the limits */
};

struct hydro_settings {
  uint8_t mode;                   /* enum hydro_mode */
  uint16_t sample_interval_ticks; /* ticks from one sample to the next, 1 or more */
  uint32_t watchdog_ticks;        /* N */
  uint32_t transfer_ticks;        /* ticks in which the effect of a change of gains fades out */
  float voltage_limit;            /* V of eq. (1), +/- */
  float pressure_limit;           /* of p1 and p2 */
  float motor_speed_limit;        /* rad/s, +/- */
  float arm_angle_limit;          /* +/- */
  float reference_limit;          /* of dp_ref, +/- */
  float output_scale;             /* V of eq. (1) per V at the terminal; not 0 */
  float output_offset;            /* V of eq. (1) at 0 V at the terminal */
  float read_back_tolerance;      /* V at the terminal; 0: no check */
  struct hydro_sensor_settings sensors[HYDRO_SENSORS];
};

struct hydro_arm {
  uint32_t fingerprint;
  uint32_t trips; /* as the newest sample reports it */
};

struct hydro_gains {
  float k_p;                   /* V per unit of pressure */
  float k_v;                   /* pressure s/rad */
  float reference_feedforward; /* V per unit of pressure */
  float arm_speed_ratio;       /* c/D; 0: off */
};

struct hydro_command {
  uint32_t fingerprint;
  int64_t host_tick;        /* the computer's; echoed with the command that is obeyed */
  float voltage;            /* HYDRO_VOLTAGE: V of eq. (1) */
  float pressure_ref;       /* HYDRO_PRESSURE: dp_ref */
  struct hydro_gains gains; /* HYDRO_PRESSURE */
};

struct hydro_identity {
  uint8_t state;        /* enum hydro_state */
  uint8_t modes;        /* bit 0: HYDRO_REMOTE_IO, bit 1: HYDRO_LOOP_ON_DEVICE */
  uint16_t firmware[3]; /* major, minor, patch */
  uint32_t boot;        /* another number after each reset */
  uint32_t tick_rate_hz;
  uint64_t tick;
  uint32_t session_in_charge; /* 0: none */
  uint32_t fingerprint;       /* of the settings held; 0: none */
  uint8_t analog_inputs;
  uint8_t counters;
  float output_min_V; /* at the terminal */
  float output_max_V;
  char board[HYDRO_BOARD_NAME_BYTES]; /* padded with zeros */
};

struct hydro_settings_held {
  uint8_t refused;      /* 0: taken; else enum hydro_refusal, and the settings in force are unchanged */
  uint8_t refused_part; /* HYDRO_REFUSED_SENSOR: index of the sensor */
  uint32_t fingerprint; /* of `settings`; 0: none held, and `settings` is all zeros */
  struct hydro_settings settings;
};

enum hydro_refusal {
  HYDRO_TAKEN = 0,
  HYDRO_REFUSED_ARMED = 1, /* settings change at zero volts only */
  HYDRO_REFUSED_MODE = 2,
  HYDRO_REFUSED_INTERVAL = 3, /* sample_interval_ticks: 1 to the tick rate */
  HYDRO_REFUSED_WATCHDOG = 4, /* watchdog_ticks: 1 to the tick rate, that is a second */
  HYDRO_REFUSED_LIMIT = 5,    /* a limit that is not a number above 0 */
  HYDRO_REFUSED_OUTPUT = 6,   /* output_scale, output_offset or read_back_tolerance */
  HYDRO_REFUSED_SENSOR = 7,   /* kind, channel, counter_bits, low_pass_share or a number that is not finite */
  HYDRO_REFUSED_MISSING = 8,  /* a sensor that the mode or a limit needs is HYDRO_SENSOR_NONE */
  HYDRO_REFUSED_ZERO = 9      /* the terminal cannot reach 0 V of eq. (1) */
};

struct hydro_sample {
  uint64_t tick;              /* the device's clock */
  uint8_t state;              /* enum hydro_state */
  uint8_t source;             /* enum hydro_source */
  uint8_t saturated;          /* 1: the command asked for more than the limit */
  uint8_t sensor_faults;      /* a bit for each sensor */
  uint16_t faults_present;    /* bits of enum hydro_fault */
  uint16_t faults_latched;    /* faults that tripped, until the next HYDRO_ARM that is taken */
  uint32_t trips;             /* counts each time that HYDRO_ARMED ends */
  uint32_t command_sequence;  /* of the newest command obeyed */
  int64_t host_tick;          /* of the newest command obeyed */
  uint32_t command_age;       /* in ticks of the device */
  float value[HYDRO_SENSORS]; /* NaN: not measured, or not credible */
  int32_t motor_count;        /* unwrapped modulo 2^32, where the motor angle is a counter; else 0 */
  int32_t arm_count;
  float voltage;           /* V of eq. (1), acting from this tick on */
  float read_back;         /* V of eq. (1), measured before `voltage` was written; NaN: not possible */
  float pressure_ref;      /* in force; 0 without the law */
  float transfer;          /* V, in `voltage`: the remainder of the law before a change of gains */
  uint16_t frames_bad;     /* counts, modulo 2^16: damaged */
  uint16_t frames_refused; /* intact, but of another session, old or repeated, or not allowed now */
};

struct hydro_output {
  uint64_t tick;
  float volts; /* at the terminal, from this tick on */
};

struct hydro_converters {
  uint64_t tick; /* of the newest HYDRO_OUTPUT before these readings */
  float analog_V[HYDRO_ANALOG_INPUTS];
  uint32_t counter[HYDRO_COUNTERS];
  float read_back_V; /* at the terminal; NaN: none */
  uint8_t interlock; /* 1: closed, the motor may move */
};

struct hydro_frame {
  uint8_t protocol;  /* as received; hydro_encode() writes HYDRO_PROTOCOL in any case */
  uint8_t kind;      /* enum hydro_kind */
  uint32_t session;  /* chosen by the computer with each HYDRO_HELLO, not 0 */
  uint32_t sequence; /* of the sender: one more in each frame */
  union {
    struct hydro_settings settings;
    struct hydro_arm arm;
    struct hydro_command command;
    struct hydro_identity identity;
    struct hydro_settings_held held;
    struct hydro_sample sample;
    struct hydro_output output;
    struct hydro_converters converters;
  } body;
};

/* Collects bytes until a frame is whole. Initialise it with zeros. */
struct hydro_receiver {
  uint8_t bytes[HYDRO_FRAME_MAX + 1];
  size_t count;
  bool overflow;
  uint32_t bad; /* pieces between delimiters that were not frames */
};

/* Writes a frame in the form in which it goes over the wire, with a delimiter before and after it. Returns
 * the number of bytes, or 0 for a kind that does not exist. */
size_t hydro_encode(const struct hydro_frame* frame, uint8_t wire[HYDRO_WIRE_MAX]);

/* Takes one byte. When it returns true, `frame` is a whole and undamaged frame; otherwise `frame` is
 * unchanged. Frames of another protocol are bad, except HYDRO_HELLO and HYDRO_IDENTITY: the caller must
 * check their protocol. */
bool hydro_receive(struct hydro_receiver* receiver, uint8_t byte, struct hydro_frame* frame);

/* Forgets a piece of a frame, for a new connection or the next datagram. */
void hydro_receive_anew(struct hydro_receiver* receiver);

/* CRC-32 of IEEE 802.3 (as zlib's crc32). Begin with 0; the result of one part begins the next. */
uint32_t hydro_crc32(uint32_t crc, const uint8_t* bytes, size_t count);

/* CRC-32 of the protocol's number and of the settings in the form in which they go over the wire; never 0. */
uint32_t hydro_fingerprint(const struct hydro_settings* settings);

/* Returns true when sequence `next` is newer than `before`; sequences wrap at 2^32. */
static inline bool hydro_is_newer(uint32_t next, uint32_t before) {
  const uint32_t ahead = next - before;
  return ahead != 0 && ahead < UINT32_C(0x80000000);
}

#ifdef __cplusplus
}
#endif

#endif
