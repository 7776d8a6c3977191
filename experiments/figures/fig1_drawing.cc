#include "experiments/figures/fig1_drawing.h"

#include <spdlog/fmt/fmt.h>

#include "experiments/figures/drawings.h"
#include "page/svg.h"

namespace hydro::experiments {

std::string ApparatusDrawing(const model::Parameters& p) {
  const auto number = [](double value) { return fmt::format("{:g}", value); };
  return page::FillDrawing(kApparatusDrawing, {{"k_1", number(p.k_1)},
                                               {"T_pmax", number(p.T_pmax)},
                                               {"D", number(p.D)},
                                               {"J", number(p.J)},
                                               {"b", number(p.b)},
                                               {"T_s", number(p.T_s)},
                                               {"f", number(p.f)},
                                               {"beta", number(p.beta)},
                                               {"c_I", fmt::format("{:.1e}", p.c_I)},
                                               {"c_E", fmt::format("{:.1e}", p.c_E)},
                                               {"p_3", number(p.p_3)},
                                               {"V_ms", number(p.V_ms)},
                                               {"c", fmt::format("{:.4g}", p.c)},
                                               {"k_2", number(p.k_2)},
                                               {"J_a", number(p.J_a)}});
}

}  // namespace hydro::experiments
