// A small complete configuration in memory, for tests of the applications.
#pragma once

#include "settings/stack_config.h"
#include "tests/table1.h"

namespace hydro::testing {

// Table 1, free arm, 1 kHz plant and pressure loop, 200 Hz position loop, lockstep, gains given.
inline settings::StackConfig SmallStack() {
  settings::StackConfig config;
  config.file = "test.toml";
  config.agreed = "version = 'test'\n";
  config.model.description.name = "Table 1";
  config.model.description.parameters = Table1();
  config.model.initial_pressure_psi = 100;
  config.time.mode = settings::TimeMode::kLockstep;
  config.time.duration_s = 0.1;
  config.plant.rate_hz = 1000;
  config.pressure.k_p = 0.125;
  config.pressure.k_v = 8;
  config.position.c1 = 1000;
  config.position.c2 = 30;
  config.position_interval_ticks = 5;
  config.last_tick = 100;
  return config;
}

}  // namespace hydro::testing
