/* Checks whether a device can act by the settings it was sent. */
#ifndef HYDRO_FIRMWARE_SETTINGS_H
#define HYDRO_FIRMWARE_SETTINGS_H

#include "firmware/sensors.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns HYDRO_TAKEN, or the first thing that is wrong; `part` is the sensor's index for
 * HYDRO_REFUSED_SENSOR, otherwise 0. */
enum hydro_refusal hydro_check_settings(const struct hydro_settings* settings,
                                        const struct hydro_board_facts* facts, uint8_t* part);

/* V of eq. (1) that the terminal can reach and the limit allows; low is above high when there are none. */
struct hydro_voltage_range {
  float low;
  float high;
};
struct hydro_voltage_range hydro_reachable_voltages(const struct hydro_settings* settings,
                                                    const struct hydro_board_facts* facts);

#ifdef __cplusplus
}
#endif

#endif
