#include "experiments/figures/fig8_block_diagram.h"

#include <spdlog/fmt/fmt.h>

#include "experiments/figures/drawings.h"
#include "page/svg.h"

namespace hydro::experiments {

std::string DrawPositionLoop(const design::DesignModel& m, double gain) {
  const auto number = [](double value) { return fmt::format("{:g}", value); };
  return page::FillDrawing(kPositionLoopDrawing,
                           {{"zero", number(m.zero)},
                            {"omega_n", number(m.natural_frequency)},
                            {"omega_n_squared", number(m.natural_frequency * m.natural_frequency)},
                            {"two_zeta_omega_n", number(2 * m.damping_ratio * m.natural_frequency)},
                            {"zeta", number(m.damping_ratio)},
                            {"k_2", number(m.k_2)},
                            {"J_a", number(m.J_a)},
                            {"gain", number(gain)},
                            {"c_1", number(m.zero * gain)},
                            {"c_2", number(gain)}});
}

}  // namespace hydro::experiments
