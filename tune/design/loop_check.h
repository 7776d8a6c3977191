// How far the loops of a configuration are from instability: the whole stack as it samples and delays, linearised
// exactly wherever its actuator works.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pressure_ctrl/law/pressure_law.h"
#include "settings/stack_config.h"
#include "tune/design/loop_margins.h"

namespace hydro::design {

struct CheckedLoop {
  LoopMargins worst;       // each number the worst one of all cases
  std::string worst_case;  // where the gain margin is the least
  // False where the two loops' intervals do not divide each other: `worst` then says only whether the loop is stable.
  bool margins_known = true;
};

struct CheckedCase {
  std::string name;
  LoopMargins pressure;
  std::optional<LoopMargins> position;
};

struct LoopCheck {
  // Eq. (16) with a constant reference, cut at the voltage: `gain` is a factor on k_p with k_v as it is, `delay` what the
  // amplifier may be late more than configured. Where a pressure drives a free arm is
  // not this loop's affair: the arm's angle is held (not its speed), and a drift that does not oscillate is left out.
  std::optional<CheckedLoop> pressure;
  // Eq. (17) around the closed pressure loop, cut at the pressure reference: `gain` is a factor on both c1 and c2. Unstable
  // with a stable pressure loop: it is the position loop that makes it so.
  std::optional<CheckedLoop> position;
  std::vector<CheckedCase> cases;
  std::string unjudged;  // why a loop that the configuration closes could not be judged; empty: it was
  // Of `unjudged`: that loop moves something, and nobody knows how. False for one that cannot move its arm.
  bool unknown = false;

  // Every loop that moves something is known to be stable.
  bool stable() const;
};

// Which loops there are follows from reference.signal: both for arm_angle, the pressure loop for pressure and torque, none
// for voltage. Limits, the D/A converter's steps, noise and Coulomb friction are left out: a loop that is stable here may still
// overshoot after saturation. Throws nothing for a configuration that settings accepts.
LoopCheck CheckLoops(const settings::StackConfig& config);

// The same with gains that do not follow from the configuration's model: of a rig that is not quite as its model says.
LoopCheck CheckLoops(const settings::StackConfig& config, const pressure_ctrl::PressureLawSettings& pressure);

// One line for a person: "pressure loop: gain margin 3.1, phase margin 48 deg at 21 Hz, ... (worst: side 2 compresses, arm
// at 0.82 rad)".
std::string Describe(const LoopCheck& check);

}  // namespace hydro::design
