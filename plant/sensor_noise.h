// The simulated sensors add noise and round. The noise depends only on the seed, the tick and the signal, so
// that a tick gets the same noise in lockstep, in real time and in hydro-sim, whichever ticks were skipped
// before it.
#pragma once

#include <cstdint>

#include "model/actuator.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// A standard normal number that depends only on (seed, tick, channel), whatever else is drawn.
double StandardNormal(uint64_t seed, int64_t tick, int channel);

// Whether the sensors read exact values, with neither noise nor rounding.
bool ReadsExactly(const settings::NoiseSection& noise);

// `measurement` as the sensors read it at `tick`: with noise, then rounded to a multiple of the resolution.
model::Measurement ReadSensors(const model::Measurement& measurement, const settings::NoiseSection& noise,
                               int64_t seed, int64_t tick);

}  // namespace hydro::plant
