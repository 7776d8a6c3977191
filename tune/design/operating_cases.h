// The operating points of a configuration's actuator, at which its equations are linearised.
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

// rad, how far from mid-stroke a free arm works: limits.arm_angle. The default of this limit is 2 % below
// V_ms/c. No arm works there, because a side with hardly any fluid is so stiff that few loops are stable.
// Without a configured limit, half of V_ms/c is used, or the farthest reference if that is more.
double LargestArmAngle(const settings::StackConfig& config);

// The same from its parts: `stop` is the end of the stroke, model::Travel::nearer(); `limit` is
// limits.arm_angle; `farthest` is the arm's start or the farthest point of the reference.
double LargestArmAngle(double stop, double limit, double farthest);

// The arm is at mid-stroke and at LargestArmAngle on either side (for a clamped arm, where it is clamped; for
// a driven one, at the middle and the ends of its motion). In each place there is a case with both sides
// compressing, and one with each side held at p_3 by its valve. A model with effects is examined with low and
// with high pressures, and also backwards where the effects distinguish the directions. The pump slips so
// fast that no friction falls with speed any more. An arm that an effect may hold is examined as it slips
// and, for the pressure loop, also as it sticks. A sticking pump is no case, because no voltage moves it and
// so no loop is closed. Throws model::ModelError.
std::vector<OperatingCase> OperatingCases(const settings::StackConfig& config);

}  // namespace hydro::design
