// Forecasts what the machine will do when it is re-armed, as far as that can be known: where the reference
// returns to, how far that is from the arm, and how fast it moves. While the voltage is held at zero, the
// published reference follows the arm and does not show this. Load and limits decide whether the machine
// follows its reference: what the model says of that is simulated (rearm_motion.h), and where nothing can be
// simulated, the forecast says so. One function serves every page and terminal from which the machine is
// re-armed. Pure.
#pragma once

#include <hydro/arm_plan_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "tune/live/rearm_motion.h"

namespace hydro::tuning {

// A jump of the reference on its way back.
struct ReferenceStep {
  double after_s = 0;  // after the re-arm
  // Smaller than the configured step: during the return, the reference follows the step only in part.
  double by = 0;
};

// Where the reference turns round on its way back.
struct ReferenceTurn {
  double after_s = 0;  // the re-arm
  double at = 0;
};

struct RearmForecast {
  bool held = true;       // the voltage is held at zero: otherwise a re-arm changes nothing
  bool known = false;     // otherwise there is only `text`, which says why not
  std::string quantity;   // what the reference refers to, "arm_angle", "pressure", "torque" or "voltage"
  std::string unit;       // of the numbers that follow
  double resolution = 0;  // a smaller move is none: the sensor's resolution, or 1e-6 of the stroke
  double present = 0;     // where it is now
  double target = 0;      // where the reference will have come back to
  double return_s = 0;    // in which plant time; 0: at once
  double top_rate = 0;    // per second, the fastest on that way, jumps of the reference left out
  bool jumps = false;     // the reference jumps on that way
  // Where that way leaves the range between its ends: it may begin in the other direction, or lead beyond its
  // end.
  std::vector<ReferenceTurn> turns;
  double speed =
      0;  // per second, at which the arm moves now; NaN: not measured, or no arm's angle is followed
  std::vector<ReferenceStep> steps;  // where it does, if return_s is not 0; the first kMostSteps of them
  // What the reference does in the kForecast_s after that.
  double lowest = 0;
  double highest = 0;
  double last = 0;       // where it is then
  bool one_way = false;  // it only rises, or only falls
  // The largest pressure, torque or voltage that a limit lets through of such a reference, and that limit.
  double most = std::numeric_limits<double>::infinity();
  std::string most_by;
  RearmMotion motion;  // what the machine does, by its model
  std::string text;    // one line for a person
};

inline constexpr double kForecast_s = 10;
inline constexpr size_t kMostSteps = 100;

// The newest of each message that a stack has sent.
struct HeardOfStack {
  std::optional<run_description_t> run;
  std::optional<tuned_settings_t> in_force;  // none: as configured
  std::optional<arm_plan_t> plan;            // of a planner
  std::optional<state_t> state;
  // The plant has said that a fault of its own holds the voltage. A state says so too; but where a device
  // does not do as it is told, the state says what the device does.
  bool holds = false;
};

// The forecast for a re-arm now.
RearmForecast ForecastRearm(const HeardOfStack& heard);

// The configuration that a running stack uses. Throws InputError when the description is not one of this
// version.
settings::StackConfig ConfigInForce(const run_description_t& run, const tuned_settings_t& in_force);

}  // namespace hydro::tuning
