// The search for gains. The same inputs give the same result, whatever the number of threads.
#pragma once

#include <functional>
#include <vector>

#include "tune/design/loop_check.h"
#include "tune/search/step_judge.h"

namespace hydro::tune {

// The margins that every proposal keeps, in every case in which the loops are checked.
inline constexpr double kLeastGainMargin = 2;
inline constexpr double kLeastPhaseMargin = 30;  // degrees

// Gains that were tried.
struct Tried {
  Gains gains;
  design::LoopCheck check;
  StepVerdict steps;
};

struct SearchResult {
  Tried best;
  std::vector<Tried> tried;  // all gains that keep the margins
  bool found = false;        // whether any gains do
};

// Progress from 0 to 1.
using Progress = std::function<void(double)>;

// Gains of the pressure loop alone: those of the configuration if they keep the margins with both
// feed-forwards, otherwise the fastest slower gains that do. Throws std::runtime_error when there are none.
Gains ChoosePressureLoop(const settings::StackConfig& config);

// Gains of the position loop around `pressure`. With a goal of bandwidth or settling time, those that meet it
// with the widest margins; without one, the fastest. If no gains meet the goals, those that come nearest.
// `braking`: with a braking curve before eq. (17).
SearchResult SearchGains(const StepJudge& judge, const Goals& goals, const Gains& pressure, bool braking,
                         int jobs, const Progress& progress);

// Tries these gains, whatever their margins.
Tried TryGains(const StepJudge& judge, const Gains& gains);

bool KeepsMargins(const design::LoopCheck& check);

// By how much gains miss the goals, relatively; 0: they meet all of them.
double Misses(const Goals& goals, const Tried& tried);

// Whether the arm settles with these gains in every case that was tried with the model as it is.
bool Settles(const Tried& tried);

// Whether the search rates `found` better than `other`, which need not keep the margins. Without a goal the
// steps alone count: what keeps wider margins and settles later is slower, not better.
bool IsBetter(const Goals& goals, const Tried& found, const Tried& other);

}  // namespace hydro::tune
