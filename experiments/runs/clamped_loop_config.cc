#include "experiments/runs/clamped_loop_config.h"

#include <spdlog/fmt/fmt.h>

namespace hydro::experiments {

std::string ClampedLoopConfig(const ClampedLoop& loop) {
  return fmt::format(R"([model]
file = "model.toml"
shaft = "clamped"
arm_angle = {}
initial_pressure = {}
[time]
mode = "lockstep"
duration_s = {}
[plant]
rate_hz = {}
command_delay_ticks = {}
[pressure]
k_p = {}
k_v = {}
[position]
sample_interval_s = {}
[limits]
pressure = inf
[reference]
signal = "pressure"
{})",
                     loop.arm_angle, loop.initial_pressure, loop.duration, loop.rate_hz, loop.delay_ticks,
                     loop.gains.k_p, loop.gains.k_v, 1 / loop.rate_hz, loop.reference);
}

}  // namespace hydro::experiments
