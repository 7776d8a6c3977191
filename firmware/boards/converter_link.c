#include "firmware/boards/converter_link.h"

void hydro_converter_link_begin(struct hydro_converter_link* link, uint32_t stale_ticks) {
  *link = (struct hydro_converter_link){.age_ticks = stale_ticks, .stale_ticks = stale_ticks};
}

bool hydro_converter_link_take(struct hydro_converter_link* link, uint8_t byte) {
  struct hydro_frame frame;
  if (!hydro_receive(&link->receiver, byte, &frame) || frame.kind != HYDRO_CONVERTERS) return false;
  link->newest = frame.body.converters;
  link->arrived = true;
  return true;
}

void hydro_converter_link_read(struct hydro_converter_link* link, struct hydro_readings* readings) {
  if (link->arrived) {
    link->age_ticks = 0;
  } else if (link->age_ticks < link->stale_ticks) {
    link->age_ticks += readings->elapsed_ticks;
  }
  link->arrived = false;
  readings->answered = link->age_ticks < link->stale_ticks;
  readings->interlock_closed = link->newest.interlock == 1;
  for (size_t i = 0; i < HYDRO_ANALOG_INPUTS; ++i) readings->analog_V[i] = link->newest.analog_V[i];
  for (size_t i = 0; i < HYDRO_COUNTERS; ++i) readings->counter[i] = link->newest.counter[i];
  /* A value read back before the newest volts arrived does not show them. */
  const bool current = link->outputs > 0 && link->newest.tick == link->outputs - 1;
  readings->read_back_V = current ? link->newest.read_back_V : HYDRO_NOT_A_NUMBER;
}

size_t hydro_converter_link_output(struct hydro_converter_link* link, float volts,
                                   uint8_t wire[HYDRO_WIRE_MAX]) {
  struct hydro_frame frame = {.kind = HYDRO_OUTPUT, .sequence = (uint32_t)link->outputs};
  frame.body.output = (struct hydro_output){.tick = link->outputs, .volts = volts};
  ++link->outputs;
  return hydro_encode(&frame, wire);
}
