/* The pressure law, eq. (16), in single precision. The C++ law (pressure_ctrl/law/pressure_law.h) gives
 * the same voltages to rounding. Pure: no clock, and no state but what is passed in. */
#ifndef HYDRO_FIRMWARE_LAW_H
#define HYDRO_FIRMWARE_LAW_H

#include "firmware/frames.h"

#ifdef __cplusplus
extern "C" {
#endif

struct hydro_law_input {
  float pressure_ref; /* dp_ref */
  float p1;
  float p2;
  float motor_speed; /* rad/s */
  float arm_speed;   /* used only with arm_speed_ratio */
};

/* Makes a change of gains without a jump. Initialise it with zeros. */
struct hydro_transfer {
  float offset;   /* V, the difference between the laws before and after the change */
  uint32_t left;  /* ticks until it has faded out */
  uint32_t total; /* ticks; 0: no change is in progress */
};

/* V, without a limit:
 *   v = k_p ((dp_ref - dp) - k_v (theta' - arm_speed_ratio alpha')) + reference_feedforward dp_ref */
float hydro_law(const struct hydro_gains* gains, const struct hydro_law_input* input);

/* From now on the law is a new one: `before` is the voltage of the law in force, `after` that of the new
 * one for the same input. The difference fades out within `ticks`; 0: at once. */
void hydro_transfer_begin(struct hydro_transfer* transfer, float before, float after, uint32_t ticks);

/* The voltage, V, to add to that of the new law. */
float hydro_transfer_now(const struct hydro_transfer* transfer);

/* Lets ticks pass. */
void hydro_transfer_pass(struct hydro_transfer* transfer, uint32_t ticks);

bool hydro_same_gains(const struct hydro_gains* a, const struct hydro_gains* b);
bool hydro_finite_gains(const struct hydro_gains* gains);

/* False for NaN and infinite values. It does without math.h, which a freestanding compiler lacks. */
static inline bool hydro_is_finite(float value) { return value - value == 0.0f; }

static inline float hydro_clamp(float value, float low, float high) {
  return value < low ? low : value > high ? high : value;
}

#ifdef __cplusplus
}
#endif

#endif
