// Where the actuator of a configuration works: the points at which its equations are linearised.
#pragma once

#include <string>
#include <vector>

#include "model/linearise.h"
#include "settings/stack_config.h"

namespace hydro::design {

struct OperatingCase {
  std::string name;            // "both sides compress, arm at 0 rad"
  model::LinearModel model;    // the pump slips
  std::vector<double> scales;  // Equations::scales() of its states
  int actuator_angle = -1;     // the state of the actuator's own angle; -1: the arm is not free
  bool arm_sticks = false;     // then only the pressure loop is closed: no position loop moves the arm
};

// rad: how far from mid-stroke a free arm works. limits.arm_angle; its default, V_ms/c but for 2 %, is no place to work at, since
// a side with hardly any fluid is so stiff that hardly a loop is stable there: without the limit it is half of V_ms/c, or
// as far as the reference goes if that is more.
double LargestArmAngle(const settings::StackConfig& config);

// The same of its parts: `stop`, the end of the stroke, model::Travel::nearer(); `limit`, of limits.arm_angle; `farthest`, of where the arm starts and where the reference goes.
double LargestArmAngle(double stop, double limit, double farthest);

// The arm at mid-stroke and at LargestArmAngle on either side (where a clamped arm is; at the middle and the
// ends of a driven one's motion). In each place with both sides compressing and with each side held at p_3 by
// its valve. A model with effects is looked at with low and with high pressures, and backwards where the
// effects tell the directions apart; the pump slips fast enough that no friction falls with speed any more.
// An arm that an effect may hold is looked at as it slips and, for the pressure loop, as it sticks. A pump
// that sticks is no case: no voltage moves it, so that no loop is closed. Throws model::ModelError.
std::vector<OperatingCase> OperatingCases(const settings::StackConfig& config);

}  // namespace hydro::design
