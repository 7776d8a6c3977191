// hydro-log summary: how well the arm followed its reference, and how well the processes kept time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/unit_system.h"
#include "runs/info.h"
#include "runs/run_log.h"
#include "runs/step_response.h"

namespace hydro::runs {

// The arm's values are in the unit of its coordinate: rad, or that of length of a linear arm.
struct Tracking {
  UnitSystem units;            // of the run's model
  bool has_reference = false;  // the log has arm-angle references and measured arm angles
  double rms_error_rad = 0;    // over the run
  double final_error_rad = 0;  // arm minus reference, the mean of the last 0.1 s
  double target_rad = 0;       // last reference
  bool held = false;           // the voltage was held at zero at the end: the reference followed the arm
  // |final error| within 2 % of the largest step, at least 0.001 rad or 0.1 mm. None: the reference is still moving, or held.
  std::optional<bool> at_target;
  std::vector<StepResponse> steps;  // empty when the reference is not made of steps
  int steps_left_out = 0;           // whose response a hold, a ramp or a curve of the reference ended
};

// The arm's tracking in a run. A step is a change of the reference with a rest of at least 0.2 s before and
// after it; more than 100 are not listed.
Tracking TrackArm(const RunLog& log);

// Several lines for people to read, with loop timing and losses. With `si`, angles also in degrees.
std::string SummaryText(const Tracking& tracking, const LogInfo& info, bool si);

// The part of it that comes first: why the run ended, in a line; empty: at its duration, or the log does not say.
std::string EarlyEndText(const LogInfo& info);

// "fault at tick 12: pressure_limit began (plant)"
std::string FaultText(const fault_t& fault);

// The part of it on loop timing.
std::string LoopsText(const LogInfo& info);

// The same as JSON.
std::string SummaryJson(const Tracking& tracking, const LogInfo& info);

}  // namespace hydro::runs
