// Which stack's channels of a log are read, where it holds several.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "runs/run_log.h"
#include "runs/stack_choice.h"

namespace hydro::runs {

// A joint of a limb in a log: its channels end in "_" and its name, behind what the limb's own channels end in.
struct JointChannels {
  std::string name;
  std::string suffix;  // of its channels
  std::string limb;    // of the limb's own
};

// The suffixes of the state channels that a log holds.
std::set<std::string> StateSuffixes(const RunLog& log);

// The joints whose states a log holds, by suffix; empty: it is not of a limb. `log` has its list of channels.
std::vector<JointChannels> JointsIn(const RunLog& log);

// More joints than that are no limb but made-up channels: whoever wants one names it.
inline constexpr size_t kMostJoints = 1000;

// Whether `choice` leaves open which of several joints is meant.
bool IsWholeLimb(const RunLog& log, const StackChoice& choice);

// The suffix to read, by the rule of ReadRunLog(). `log` has its list of channels. Throws InputError.
std::string ChooseSuffix(const RunLog& log, const StackChoice& choice);

}  // namespace hydro::runs
