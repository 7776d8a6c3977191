// What the measured signals themselves say of the model's switches: when the pump turns, and which way.
#pragma once

#include <cstdint>
#include <vector>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

struct ObservedMode {
  // Averages over some milliseconds, which is less than a sample in slow recordings; NaN: not measured.
  std::vector<double> motor_speed, p1, p2;
  // What noise leaves of them: values closer to 0 (to p_3) than this may be either side of it.
  size_t half_window = 0;  // samples on either side that an average is of
  double speed_margin = 0, p1_margin = 0, p2_margin = 0;
  // From each sample to the next: +1 and -1, the pump turns; 0, its speed is 0 within the noise.
  std::vector<int8_t> turns;
  // 1: it passes through 0 too quickly to be at rest; friction may have either sign.
  std::vector<uint8_t> passes;

  bool speed_measured() const { return !turns.empty(); }
};

ObservedMode ObserveMode(const RunData& run);

}  // namespace hydro::diagnose
