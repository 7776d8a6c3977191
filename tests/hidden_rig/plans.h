// What an experimenter does with the rig: the same in every case, except for amplitudes drawn from the seed.
#pragma once

#include <cstdint>
#include <vector>

#include "rig.h"

namespace hidden_rig {

// Six runs, two of each kind: bypass open, clamped (at two angles), free under the position loop. With
// `driven`, a seventh whose shaft is moved from outside.
std::vector<Plan> Plans(uint64_t seed, double seconds, bool driven);

}  // namespace hidden_rig
