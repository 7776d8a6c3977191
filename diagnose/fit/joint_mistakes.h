// Mistakes that come together: every combination is held against the balances of the signals.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/data/recording_mistake.h"
#include "diagnose/data/signal_balances.h"

namespace hydro::diagnose {

// The most that a recording may have.
inline constexpr size_t kMostMistakes = 4;

// The `most` combinations of these mistakes with which the balances close best, one mistake fewer counting for more;
// best first. One that leaves as much open as none at all is not among them.
std::vector<std::vector<RecordingMistake>> JointMistakes(const SignalBalances& balances,
                                                         const std::vector<RecordingMistake>& possible,
                                                         size_t most);

}  // namespace hydro::diagnose
