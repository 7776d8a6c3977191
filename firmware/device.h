/* The device as a state machine: frames and readings in, terminal volts and frames out. Pure: it reads no
 * clock, and its time is the board's ticks. docs/front_end.md has its states, faults and limits. */
#ifndef HYDRO_FIRMWARE_DEVICE_H
#define HYDRO_FIRMWARE_DEVICE_H

#include "firmware/law.h"
#include "firmware/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { HYDRO_FIRMWARE_MAJOR = 1, HYDRO_FIRMWARE_MINOR = 0, HYDRO_FIRMWARE_PATCH = 0 };

/* The command in force, and how old it is. */
struct hydro_obeyed {
  bool any;       /* since arming */
  bool fresh;     /* a command, or the arming, came after the last tick */
  uint8_t source; /* enum hydro_source */
  uint32_t sequence;
  uint32_t age_ticks; /* at the last tick; counts from the arming until a command comes */
  struct hydro_command command;
};

struct hydro_device {
  struct hydro_board_facts facts;
  uint8_t state; /* enum hydro_state */
  uint64_t tick;
  uint32_t session;     /* in charge; 0: none */
  uint32_t heard_ticks; /* since the last frame of the session in charge */
  uint32_t newest;      /* sequence of the last frame taken */
  uint32_t sent;        /* frames sent */
  uint32_t trips;
  uint16_t faults_present;   /* of the last tick, the lasting ones */
  uint16_t faults_momentary; /* since the last sample */
  uint16_t faults_latched;
  uint16_t frames_refused;
  uint32_t fingerprint; /* of the settings; 0: none */
  struct hydro_settings settings;
  struct hydro_sensors sensors;
  struct hydro_obeyed obeyed;
  struct hydro_gains gains; /* those with which the law acted in the last tick, if acted_by_law */
  bool acted_by_law;
  struct hydro_transfer transfer;
  float zero_volts;          /* at the terminal: the voltage that is 0 V of eq. (1) */
  float written_volts;       /* at the terminal */
  uint8_t read_back_differs; /* ticks in a row */
  uint32_t sample_in_ticks;
  bool owes_identity;
  bool owes_held;
  bool owes_sample;
  uint8_t refused; /* of the settings that were answered last */
  uint8_t refused_part;
  struct hydro_sample sample;
  struct hydro_receiver receiver;
};

/* The state after a reset: no settings, zero volts. */
void hydro_device_begin(struct hydro_device* device, const struct hydro_board_facts* facts);

/* Takes a byte of the link. Returns true when the byte ended a HELLO whose session was taken, or was in
 * charge before: from now on, answers go to the link's other end. */
bool hydro_device_receive(struct hydro_device* device, uint8_t byte);

/* Takes one tick; returns the volts to write to the terminal. */
float hydro_device_tick(struct hydro_device* device, const struct hydro_readings* readings);

/* Writes the next frame that is due in the form in which it goes over the wire, and returns its number of
 * bytes; 0: none is due. */
size_t hydro_device_send(struct hydro_device* device, uint8_t wire[HYDRO_WIRE_MAX]);

#ifdef __cplusplus
}
#endif

#endif
