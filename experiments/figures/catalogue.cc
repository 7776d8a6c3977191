#include "experiments/figures/catalogue.h"

#include "experiments/studies/experiment.h"

namespace hydro::experiments {

const std::vector<Experiment>& Experiments() {
  static const std::vector<Experiment> experiments = {
      {"fig1", "Figure 1: the apparatus, and what its numbers amount to", RunFig1, 0.1},
      {"friction", "Determining T_s and b", RunFriction, 1, true},
      {"leakage", "Determining c_E and c_I", RunLeakage, 1, true},
      {"fig2", "Figure 2: stick-slip at a low torque, open loop", RunFig2, 0.7},
      {"fig3", "Figure 3: response to a torque of 10 in-lb, open loop", RunFig3, 0.1},
      {"fig4", "Figure 4: the pressure loop follows a square wave", RunFig4, 0.5},
      {"fig5", "Figure 5: the pressure loop follows a sine", RunFig5, 0.2},
      {"fig6", "Figure 6: frequency response of the pressure loop at mid-stroke", RunFig6, 1.5},
      {"fig7", "Figure 7: frequency response of the pressure loop at 90 degrees", RunFig7, 1},
      {"waves", "The 300 Hz pressure waves in the lines", RunWaves, 1.5},
      {"fig8", "Figure 8: the linear design model of the position loop", RunFig8, 0.1},
      {"fig9", "Figure 9: root locus, and the loop sampled", RunFig9, 0.1},
      {"fig10", "Figure 10: a step of the arm, linear and full model, and what the motor could do", RunFig10,
       0.7},
      {.name = "fig10_uncertainty",
       .title = "Figure 10 on machines that are not exactly Table 1",
       .run = RunFig10Uncertainty,
       .cost = 15,
       .draws_machines = true},
      {"torque", "Torque control: a commanded torque at the arm, clamped and moving", RunTorque, 1.5},
      {"coupling", "Two joints in one arm: what couples them, and what feed-forward takes away", RunCoupling,
       0.5},
  };
  return experiments;
}

}  // namespace hydro::experiments
