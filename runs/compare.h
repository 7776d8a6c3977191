// hydro-log compare: whether two runs are the same, message by message and bit by bit.
#pragma once

#include <optional>
#include <string>

#include "runs/run_messages.h"

namespace hydro::runs {

// The first place where two runs differ, as one line: "differ at tick 812: HYDRO_STATE.p2: 101.25 (a) and
// 101.26 (b)", or which message is missing where; empty when they are identical. "First" is the lowest tick;
// within one, the order of the channels in RunMessages.
//
// Messages are taken in the order of their ticks, and of their sequence numbers (faults: source, then
// sequence) within a tick, so the order of arrival does not matter, and those that are the same in every
// field count once, however often they were sent. Every field is compared but utime and session; doubles by
// their bits, so that -0 differs from 0 and a NaN equals only the same NaN.
std::optional<std::string> FirstDifference(const RunMessages& a, const std::string& name_a,
                                           const RunMessages& b, const std::string& name_b);

}  // namespace hydro::runs
