/* Functions that device.c and device_frames.c share; not for boards. */
#ifndef HYDRO_FIRMWARE_DEVICE_FRAMES_H
#define HYDRO_FIRMWARE_DEVICE_FRAMES_H

#include "firmware/device.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Ends obedience to commands, and counts a trip if the device was armed. */
void hydro_device_leave_armed(struct hydro_device* device, enum hydro_state state);

/* Reports faults that were found: an armed device trips and latches them; any device reports them in its
 * next sample. */
void hydro_device_trip(struct hydro_device* device, uint16_t faults);

/* Fills in an identity. */
void hydro_device_identify(const struct hydro_device* device, struct hydro_frame* frame);

#ifdef __cplusplus
}
#endif

#endif
