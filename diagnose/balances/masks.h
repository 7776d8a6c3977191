// Where a balance says nothing: the pump is at rest, a one-way valve may be open, or a signal is missing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "diagnose/balances/balance_series.h"

namespace hydro::diagnose {

// The pressure at which the one-way valves hold a side, as the runs show it.
struct HeldPressure {
  double at = 0;      // p_3 where the runs do not show it
  double margin = 0;  // a side is surely not held when it is more than this above `at`
};
HeldPressure FindHeldPressure(const std::vector<RunMotion>& runs, const model::Parameters& given);

// For each balance, a mask with 1 at every stride-th instant where the balance says nothing. It is empty
// where the balance cannot be formed. A level says something only where the flow shows that the valve passes
// oil.
std::array<std::vector<uint8_t>, kBalanceKinds> MasksOf(const RunMotion& run, const BalanceSeries& left,
                                                        const HeldPressure& held,
                                                        const model::Parameters& given);

}  // namespace hydro::diagnose
