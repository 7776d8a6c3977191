// hydro-log info and summary for a log with all joints of a limb.
#pragma once

#include <string>
#include <vector>

#include "runs/info.h"
#include "runs/recorded/run_log.h"
#include "runs/tracking.h"

namespace hydro::runs {

struct JointInfo {
  std::string name;
  LogInfo info;
  Tracking tracking;
};

struct LimbInfo {
  LogInfo limb;  // its own channels; faults, stops, changes and outputs are those of all joints
  std::vector<JointInfo> joints;
};

// `log` must have joints. The units are those of Summarise().
LimbInfo SummariseLimb(const LimbLog& log, bool si);

// The limb's counterparts of InfoText() and SummaryText(), with a row for each joint.
std::string LimbInfoText(const LimbInfo& info);
std::string LimbSummaryText(const LimbInfo& info);

// The limb's counterparts of InfoJson() and SummaryJson(). `joints` has the same for each joint, by name,
// together with its `tracking`.
std::string LimbInfoJson(const LimbInfo& info);
std::string LimbSummaryJson(const LimbInfo& info);

}  // namespace hydro::runs
