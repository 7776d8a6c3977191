// What is wrong with a recording, or little in it: a sentence each.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/alignment.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// Clocks that were apart; noise unlike what is said of it; sensors at the end of their range; gaps; steps
// coarser than the noise; a motor that hardly turns, or one way only; pressures that never leave the
// accumulator's. Empty when there is nothing to remark on.
std::vector<std::string> RecordingRemarks(const std::vector<ClockDelay>& clocks,
                                          const std::vector<const RunData*>& runs,
                                          const std::vector<const RunData*>& held_out);

}  // namespace hydro::diagnose
