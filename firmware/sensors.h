/* Turns the converters' readings into signals in the model's units, and judges whether they are credible. */
#ifndef HYDRO_FIRMWARE_SENSORS_H
#define HYDRO_FIRMWARE_SENSORS_H

#include "firmware/frames.h"

#ifdef __cplusplus
extern "C" {
#endif

#define HYDRO_NOT_A_NUMBER (__builtin_nanf("")) /* GCC's and clang's, without math.h */

enum {
  HYDRO_GOOD_READINGS = 10
}; /* in a row end the fault of a sensor: a loose contact must not switch the motor */

/* Facts about a board, which do not change while it runs. */
struct hydro_board_facts {
  const char* name;      /* up to 16 characters */
  uint32_t tick_rate_hz; /* 1 or more */
  uint32_t boot;         /* another number after each reset */
  uint8_t analog_inputs; /* up to HYDRO_ANALOG_INPUTS */
  uint8_t counters;      /* up to HYDRO_COUNTERS */
  bool datagrams;        /* the link carries datagrams of whole frames */
  float analog_min_V;    /* the ends of the analog inputs' range */
  float analog_max_V;
  float output_min_V; /* the ends of the output's range */
  float output_max_V;
};

/* The readings of a board in one tick. */
struct hydro_readings {
  uint32_t elapsed_ticks; /* since the last reading: 1, or more after an overrun */
  bool answered;          /* false: the converters did not answer, and the rest means nothing */
  bool overrun;           /* this tick was due before the last one was finished */
  bool interlock_closed;  /* the motor may move */
  float analog_V[HYDRO_ANALOG_INPUTS];
  uint32_t counter[HYDRO_COUNTERS];
  float read_back_V; /* at the output's terminal; NaN: cannot be read */
};

/* The state of one sensor from reading to reading. */
struct hydro_sensor {
  bool started; /* there was a reading before this one */
  bool lost;    /* a counter moved too far to be followed */
  bool fault;
  uint8_t good_readings;
  int32_t count; /* unwrapped modulo 2^32 */
  int32_t moved; /* counts since the last reading */
  float unfiltered;
  float rate;  /* of the unfiltered signal */
  float value; /* NaN: not measured, or not credible */
};

struct hydro_sensors {
  uint32_t unread_ticks; /* since the last readings that counted */
  struct hydro_sensor sensor[HYDRO_SENSORS];
};

void hydro_sensors_begin(struct hydro_sensors* sensors);

/* Takes the readings of a tick in which the converters answered. */
void hydro_sensors_read(struct hydro_sensors* sensors, const struct hydro_settings* settings,
                        const struct hydro_board_facts* facts, const struct hydro_readings* readings);

/* Call it when the converters did not answer: no signal is known. */
void hydro_sensors_unknown(struct hydro_sensors* sensors, uint32_t elapsed_ticks);

/* One bit for each sensor that is not credible. */
uint8_t hydro_sensors_faults(const struct hydro_sensors* sensors);

#ifdef __cplusplus
}
#endif

#endif
