// Chooses the stack whose channels are read from a log that holds several stacks, and the order of a
// limb's joints.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runs/log/log_reader.h"
#include "runs/recorded/run_log.h"
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

// The configurations of the limbs in a log, as the limbs describe themselves there.
class LimbConfigs {
 public:
  // Takes the first event of a channel, whichever channel it is.
  void TakeFirst(const log::LogEvent& event);

  // The configuration, as TOML, of the limb whose own channels have this suffix; empty where the log has
  // none.
  std::string Of(const std::string& limb) const;

  // Sorts the joints of each limb into the order of its configuration. Joints that are not in it come last,
  // by suffix.
  void Order(std::vector<JointChannels>* joints) const;

 private:
  std::map<std::string, std::string> texts_;  // by suffix
};

// Whether this configuration of a limb has an [arm], which couples the loads of its joints.
bool HasArm(const std::string& limb_config);

}  // namespace hydro::runs
