// What the simulated sensors make of the truth: they add noise and round. The noise depends on nothing but
// the seed, the tick and the signal: the same tick gets the same noise in lockstep, in real time and in
// hydro-sim, whatever was skipped before.
#pragma once

#include <cstdint>

#include "model/actuator.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Standard normal number for (seed, tick, channel): Box-Muller on two SplitMix64 outputs.
double StandardNormal(uint64_t seed, int64_t tick, int channel);

// `measurement` as the sensors read it at `tick`: noise added, then rounded to a multiple of the resolution.
model::Measurement ReadSensors(const model::Measurement& measurement, const settings::NoiseSection& noise,
                               int64_t seed, int64_t tick);

}  // namespace hydro::plant
