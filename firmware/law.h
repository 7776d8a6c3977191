/* The pressure law, eq. (16), in single precision. The C++ law (pressure_ctrl/law/pressure_law.h) and this one give the
 * same voltages to rounding. Pure: no clock, no state but what is passed in. */
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

/* A change of gains without a jump. Begin with all zeros. */
struct hydro_transfer {
  float offset;   /* V, what the laws before and after the change differ by */
  uint32_t left;  /* ticks until it has passed */
  uint32_t total; /* ticks; 0: nothing is passing */
};

/* V, without a limit:
 *   v = k_p ((dp_ref - dp) - k_v (theta' - arm_speed_ratio alpha')) + reference_feedforward dp_ref */
float hydro_law(const struct hydro_gains* gains, const struct hydro_law_input* input);

/* From now on, `before` is what the law in force gives, `after` what the new one gives for the same input; the
 * difference passes within `ticks`. 0: at once. */
void hydro_transfer_begin(struct hydro_transfer* transfer, float before, float after, uint32_t ticks);

/* V, to be added to the new law's voltage. */
float hydro_transfer_now(const struct hydro_transfer* transfer);

/* Ticks have passed. */
void hydro_transfer_pass(struct hydro_transfer* transfer, uint32_t ticks);

bool hydro_same_gains(const struct hydro_gains* a, const struct hydro_gains* b);
bool hydro_finite_gains(const struct hydro_gains* gains);

/* Not NaN and not infinite; without math.h, which a freestanding compiler lacks. */
static inline bool hydro_is_finite(float value) { return value - value == 0.0f; }

static inline float hydro_clamp(float value, float low, float high) {
  return value < low ? low : value > high ? high : value;
}

#ifdef __cplusplus
}
#endif

#endif
