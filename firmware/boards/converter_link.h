/* The device's end of the converter link (docs/front_end.md), for boards without converters of their own. */
#ifndef HYDRO_FIRMWARE_BOARDS_CONVERTER_LINK_H
#define HYDRO_FIRMWARE_BOARDS_CONVERTER_LINK_H

#include "firmware/sensors.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Initialise it with hydro_converter_link_begin(). */
struct hydro_converter_link {
  struct hydro_receiver receiver;
  struct hydro_converters newest;
  bool arrived; /* values have come since the last reading */
  uint32_t age_ticks;
  uint32_t stale_ticks;
  uint64_t outputs; /* number of outputs written: the tick of the next one */
};

/* `stale_ticks`: after this many ticks without values, the converters count as not answering. */
void hydro_converter_link_begin(struct hydro_converter_link* link, uint32_t stale_ticks);

/* Takes a byte from the simulator. Returns true when it ended a frame with values. */
bool hydro_converter_link_take(struct hydro_converter_link* link, uint8_t byte);

/* Fills readings with the newest values; the caller has set `elapsed_ticks`. */
void hydro_converter_link_read(struct hydro_converter_link* link, struct hydro_readings* readings);

/* Writes the frame that tells the simulator the terminal's voltage; returns the number of bytes. */
size_t hydro_converter_link_output(struct hydro_converter_link* link, float volts,
                                   uint8_t wire[HYDRO_WIRE_MAX]);

#ifdef __cplusplus
}
#endif

#endif
