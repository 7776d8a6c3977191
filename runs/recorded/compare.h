// hydro-log compare: whether two runs are the same, message by message and bit by bit.
#pragma once

#include <optional>
#include <string>

#include "runs/recorded/run_log.h"

namespace hydro::runs {

// The first difference between two runs, as one line: "differ at tick 812: HYDRO_STATE.p2: 101.25 (a) and
// 101.26 (b)", or which message is missing from which run; empty when they are identical. "First" is the
// lowest tick and, within a tick, the first channel of the table of messages.
//
// Messages are compared in tick order, within a tick by sequence number (faults: source, then sequence), so
// the order of arrival does not matter. Messages that agree in every field count once, however often they
// were sent. Every field except utime and session is compared. Doubles are compared by their bits: -0 differs
// from 0, and a NaN equals only the same NaN.
std::optional<std::string> FirstDifference(const RunMessages& a, const std::string& name_a,
                                           const RunMessages& b, const std::string& name_b);

// The same for two limbs, joint by joint: "joint knee: differ at tick ...", or which joint is missing from
// which limb. For two single stacks, as above. Throws InputError for a limb and a stack, and for runs whose
// models are in other units.
std::optional<std::string> FirstDifference(const LimbLog& a, const std::string& name_a, const LimbLog& b,
                                           const std::string& name_b);

}  // namespace hydro::runs
