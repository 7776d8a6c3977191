// hydro-log info and summary of a log with all joints of a limb.
#pragma once

#include <string>
#include <vector>

#include "runs/info.h"
#include "runs/run_log.h"
#include "runs/tracking.h"

namespace hydro::runs {

struct JointInfo {
  std::string name;
  LogInfo info;
  Tracking tracking;
};

struct LimbInfo {
  LogInfo limb;  // of its own channels; faults, stops, changes and outputs are those of all joints, named
  std::vector<JointInfo> joints;
};

// `log` has joints. Units as Summarise().
LimbInfo SummariseLimb(const LimbLog& log, bool si);

// As InfoText() and SummaryText(), with a row for each joint.
std::string LimbInfoText(const LimbInfo& info);
std::string LimbSummaryText(const LimbInfo& info);

// As InfoJson() and SummaryJson() of the limb, with `joints`: by name, the same of each, and its `tracking`.
std::string LimbInfoJson(const LimbInfo& info);
std::string LimbSummaryJson(const LimbInfo& info);

}  // namespace hydro::runs
