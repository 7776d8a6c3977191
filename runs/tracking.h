// hydro-log summary: how well the arm followed its reference, and how well the processes kept time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/unit_system.h"
#include "runs/info.h"
#include "runs/recorded/run_log.h"
#include "runs/step_response.h"

namespace hydro::runs {

// The arm's values are in the unit of its coordinate: rad, or for a linear arm the unit of length.
struct Tracking {
  UnitSystem units;            // of the run's model
  bool has_reference = false;  // the log has arm-angle references and measured arm angles
  double rms_error_rad = 0;    // over the run
  double final_error_rad = 0;  // arm minus reference, the mean over final_time_s
  double final_time_s = 0;     // the last 0.1 s, or the time since the last step where that is shorter
  double tolerance_rad = 0;    // what counts as being at the target, which is that of the last step
  double target_rad = 0;       // last reference
  bool held = false;           // the voltage was held at zero at the end, and the reference followed the arm
  // |final error| within the tolerance: 2 % of the step to the target (without steps: of the reference's
  // range), at least 0.001 rad or 0.1 mm. None: the reference is still moving, or the voltage is held.
  std::optional<bool> at_target;
  std::vector<StepResponse> steps;  // empty when the reference is not made of steps
  int steps_left_out = 0;  // steps whose response a hold, a ramp or a curve of the reference cut short
};

// The arm's tracking in a run. A step is a change of the reference with at least 0.2 s of rest before and
// after it. No more than 100 steps are listed.
Tracking TrackArm(const RunLog& log);

// Several lines for people to read, with loop timing and losses. With `si`, angles also in degrees.
std::string SummaryText(const Tracking& tracking, const LogInfo& info, bool si);

// The first part of that text: one line that says why the run ended; empty: the run reached its full
// duration, or the log does not say.
std::string EarlyEndText(const LogInfo& info);

// "fault at tick 12: pressure_limit began (plant)"
std::string FaultText(const fault_t& fault);

// The part of that text on loop timing.
std::string LoopsText(const LogInfo& info);

// The same as JSON.
std::string SummaryJson(const Tracking& tracking, const LogInfo& info);

}  // namespace hydro::runs
