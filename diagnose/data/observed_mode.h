// What the measured signals alone say about the model's switches: when the pump turns, and which way.
#pragma once

#include <cstdint>
#include <vector>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

struct ObservedMode {
  // Averages over a few milliseconds (less than a sample in slow recordings); NaN: not measured.
  std::vector<double> motor_speed, p1, p2;
  // The uncertainty that noise leaves in them: a value closer to 0 (to p_3) than this may be on either side
  // of it.
  size_t half_window = 0;  // samples on either side in an average
  double speed_margin = 0, p1_margin = 0, p2_margin = 0;
  // From each sample to the next: +1 or -1 when the pump turns; 0 when its speed is 0 within the noise.
  std::vector<int8_t> turns;
  // 1: the speed passes through 0 too quickly for the pump to be at rest; friction may have either sign.
  std::vector<uint8_t> passes;

  bool speed_measured() const { return !turns.empty(); }
};

ObservedMode ObserveMode(const RunData& run);

}  // namespace hydro::diagnose
