// Chooses the stack whose channels are read from a log that holds several stacks.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "runs/run_log.h"
#include "runs/stack_choice.h"
#include "settings/joint_documents.h"

namespace hydro::runs {

// A joint of a limb in a log. The names of its channels end in the suffix of the limb's own channels,
// followed by "_" and the joint's name.
struct JointChannels {
  std::string name;
  std::string suffix;  // of its channels
  std::string limb;    // of the limb's own
};

// The suffixes of the state channels that a log holds.
std::set<std::string> StateSuffixes(const RunLog& log);

// The joints whose states a log holds, by suffix; empty: the log is not of a limb. `log` must have its list
// of channels.
std::vector<JointChannels> JointsIn(const RunLog& log);

// More joints than this are forged channels rather than a limb. A caller that wants one of them names it.
inline constexpr size_t kMostJoints = settings::kMostJoints;

// Whether `choice` leaves open which of several joints to read.
bool IsWholeLimb(const RunLog& log, const StackChoice& choice);

// The suffix to read, by the rule of ReadRunLog(). `log` must have its list of channels. Throws InputError.
std::string ChooseSuffix(const RunLog& log, const StackChoice& choice);

}  // namespace hydro::runs
