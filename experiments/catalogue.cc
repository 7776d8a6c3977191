#include "experiments/catalogue.h"

#include "experiments/experiment.h"

namespace hydro {

const std::vector<Experiment>& Experiments() {
  static const std::vector<Experiment> experiments = {
      {"fig2", "Figure 2: stick-slip at a low torque, open loop", RunFig2, 0.7},
      {"fig3", "Figure 3: response to a torque of 10 in-lb, open loop", RunFig3, 0.1},
      {"fig4", "Figure 4: the pressure loop follows a square wave", RunFig4, 0.5},
      {"fig5", "Figure 5: the pressure loop follows a sine", RunFig5, 0.2},
  };
  return experiments;
}

}  // namespace hydro
