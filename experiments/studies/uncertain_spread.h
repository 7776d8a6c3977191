// Statistics of the steps of drawn machines: how they spread, on which parameters that depends, and which
// machines are worst.
#pragma once

#include <cstddef>
#include <vector>

#include "base/maths/estimate.h"
#include "experiments/studies/uncertain_steps.h"

namespace hydro::experiments {

inline constexpr double kMuchOvershoot = 5;  // % of the step

// One quantity over all machines. It is infinite where that many machines never settle.
struct Spread {
  double known = 0;  // for the model as its file says
  double lowest = 0, p5 = 0, p50 = 0, p95 = 0, p99 = 0, highest = 0;
};

// The influence of one base parameter on the spread.
struct Influence {
  size_t base = 0;                // in BaseParameters()
  double standard_deviation = 0;  // relative
  // maths::RankCorrelation and maths::MainEffect. A machine that never settles counts with the duration of
  // the whole run.
  double settling_correlation = 0, settling_effect = 0;
  double overshoot_correlation = 0, overshoot_effect = 0;
};

// The machines whose most influential parameter is close to the model's value.
struct Nearly {
  size_t base = 0;
  double within = 0;  // relative
  int count = 0;
  double settling_p50 = 0, settling_p95 = 0;  // s
  double overshoot_p95 = 0;                   // %
};

struct UncertainSpread {
  Spread settling, shortest, ratio;  // s, s, settling over shortest
  Spread overshoot;                  // %
  Spread error;                      // rad, magnitude
  Spread saturated;                  // s
  maths::Estimate never,
      overshoots;  // shares of the machines: never settle; overshoot by more than kMuchOvershoot
  // The largest share of machines that friction can keep from settling: those on which the pump's friction
  // can hold the arm outside 2 % of the step, in closed form from T_s, k_1 and D dp of the known model.
  double friction_holds = 0;
  std::vector<Influence> influences;  // largest settling_effect first, without parameters that are 0
  Nearly nearly;
  // Numbers of the machines that settle last. Those that never settle come first.
  std::vector<size_t> slowest;
  std::vector<size_t> most_overshoot;
};

UncertainSpread SpreadOf(const UncertainSteps& steps);

}  // namespace hydro::experiments
