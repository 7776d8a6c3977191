#include "firmware/law.h"

/* -ffast-math and its parts would make the checks for finite numbers meaningless. */
#ifdef __FAST_MATH__
#error "compile the firmware without -ffast-math"
#endif

float hydro_law(const struct hydro_gains* gains, const struct hydro_law_input* input) {
  const float pressure_error = input->pressure_ref - (input->p2 - input->p1);
  float speed = input->motor_speed;
  if (gains->arm_speed_ratio != 0.0f) speed -= gains->arm_speed_ratio * input->arm_speed;
  return gains->k_p * (pressure_error - gains->k_v * speed) +
         gains->reference_feedforward * input->pressure_ref;
}

void hydro_transfer_begin(struct hydro_transfer* transfer, float before, float after, uint32_t ticks) {
  transfer->offset = before - after;
  transfer->total = transfer->offset != 0.0f ? ticks : 0;
  transfer->left = transfer->total;
}

float hydro_transfer_now(const struct hydro_transfer* transfer) {
  if (transfer->left == 0) return 0.0f;
  return transfer->offset * ((float)transfer->left / (float)transfer->total);
}

void hydro_transfer_pass(struct hydro_transfer* transfer, uint32_t ticks) {
  transfer->left -= ticks < transfer->left ? ticks : transfer->left;
}

bool hydro_same_gains(const struct hydro_gains* a, const struct hydro_gains* b) {
  return a->k_p == b->k_p && a->k_v == b->k_v && a->reference_feedforward == b->reference_feedforward &&
         a->arm_speed_ratio == b->arm_speed_ratio;
}

bool hydro_finite_gains(const struct hydro_gains* gains) {
  return hydro_is_finite(gains->k_p) && hydro_is_finite(gains->k_v) &&
         hydro_is_finite(gains->reference_feedforward) && hydro_is_finite(gains->arm_speed_ratio);
}
