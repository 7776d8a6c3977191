// Where a balance says nothing: the pump at rest, a one-way valve perhaps open, a signal missing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "diagnose/balances/balance_series.h"

namespace hydro::diagnose {

// The pressure at which the one-way valves hold a side, as the runs show it.
struct HeldPressure {
  double at = 0;      // p_3 where the runs do not show it
  double margin = 0;  // above `at`, by which a side is surely not held
};
HeldPressure FindHeldPressure(const std::vector<RunMotion>& runs, const model::Parameters& given);

// For each balance, 1 at every stride-th instant where it says nothing; empty: it cannot be formed. A level says something only
// where the flow shows that the valve passes oil.
std::array<std::vector<uint8_t>, kBalanceKinds> MasksOf(const RunMotion& run, const BalanceSeries& left,
                                                        const HeldPressure& held,
                                                        const model::Parameters& given);

}  // namespace hydro::diagnose
