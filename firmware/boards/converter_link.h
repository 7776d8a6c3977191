/* The device's end of the converter link (docs/front_end.md), for boards that have no converters of their own. */
#ifndef HYDRO_FIRMWARE_BOARDS_CONVERTER_LINK_H
#define HYDRO_FIRMWARE_BOARDS_CONVERTER_LINK_H

#include "firmware/sensors.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Begin with hydro_converter_link_begin(). */
struct hydro_converter_link {
  struct hydro_receiver receiver;
  struct hydro_converters newest;
  bool arrived; /* values came since they were read last */
  uint32_t age_ticks;
  uint32_t stale_ticks;
  uint64_t outputs; /* how many were written: the tick of the next one */
};

/* `stale_ticks`: without values for so long, the converters do not answer. */
void hydro_converter_link_begin(struct hydro_converter_link* link, uint32_t stale_ticks);

/* Takes a byte from the simulator. True: it ended a frame with values. */
bool hydro_converter_link_take(struct hydro_converter_link* link, uint8_t byte);

/* Fills readings with the newest values; their `elapsed_ticks` is given. */
void hydro_converter_link_read(struct hydro_converter_link* link, struct hydro_readings* readings);

/* Writes the frame that tells the simulator what the terminal holds; returns its bytes. */
size_t hydro_converter_link_output(struct hydro_converter_link* link, float volts,
                                   uint8_t wire[HYDRO_WIRE_MAX]);

#ifdef __cplusplus
}
#endif

#endif
