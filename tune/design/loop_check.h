// How far the loops of a configuration are from instability. The whole stack, with its sampling and delays,
// is linearised exactly at all operating points of its actuator.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pressure_ctrl/law/pressure_law.h"
#include "settings/stack_config.h"
#include "tune/design/loop_margins.h"

namespace hydro::design {

struct CheckedLoop {
  LoopMargins worst;       // each number is the worst over all cases
  std::string worst_case;  // the case with the smallest gain margin
  // False where neither loop's interval is a multiple of the other's: `worst` then says only whether the loop
  // is stable.
  bool margins_known = true;
};

struct CheckedCase {
  std::string name;
  LoopMargins pressure;
  std::optional<LoopMargins> position;
};

struct LoopCheck {
  // Eq. (16) with a constant reference, cut at the voltage. `gain` is a factor on k_p with k_v unchanged, and
  // `delay` is how much later than configured the amplifier may be. This loop is not responsible for where a
  // pressure drives a free arm: the arm's angle is held (not its speed), and a drift that does not oscillate
  // is left out.
  std::optional<CheckedLoop> pressure;
  // Eq. (17) around the closed pressure loop, cut at the pressure reference. `gain` is a factor on both c1
  // and c2. If this is unstable with a stable pressure loop, the position loop is the cause.
  std::optional<CheckedLoop> position;
  std::vector<CheckedCase> cases;
  std::string unjudged;  // why a loop that the configuration closes could not be judged; empty: all were
  // Refers to `unjudged`: true if that loop moves something and its stability is unknown. False for a loop
  // that cannot move its arm.
  bool unknown = false;

  // Every loop that moves something is known to be stable.
  bool stable() const;
};

// reference.signal determines which loops there are: both for arm_angle, the pressure loop for pressure and
// torque, none for voltage. Limits, the D/A converter's steps, noise and Coulomb friction are left out: a
// loop that is stable here may still overshoot after saturation. Throws nothing for a configuration that
// settings accepts.
LoopCheck CheckLoops(const settings::StackConfig& config);

// The same check with gains that do not follow from the configuration's model, for a rig that differs from
// its model.
LoopCheck CheckLoops(const settings::StackConfig& config, const pressure_ctrl::PressureLawSettings& pressure);

// One line for a person: "pressure loop: gain margin 3.1, phase margin 48 deg at 21 Hz, ... (worst: side 2
// compresses, arm at 0.82 rad)".
std::string Describe(const LoopCheck& check);

}  // namespace hydro::design
