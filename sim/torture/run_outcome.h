// What a run is given, and what comes of it.
#pragma once

#include <cstdint>
#include <vector>

#include "settings/stack_config.h"
#include "sim/torture/invariants/observer.h"

namespace hydro::torture {

// What is run.
struct Stacks {
  settings::StackConfig right;
  settings::StackConfig other;          // what FaultKind::kOtherConfiguration starts a process with
  settings::StackConfig other_version;  // the same of kOtherVersion
  settings::StackConfig knee;           // the other joint of a limb
  settings::StackConfig whole;          // what an operator asks: of a limb all joints
};

struct RunOutcome {
  std::vector<Violation> violations;
  uint64_t trace = 0;  // of everything that happened
  Coverage coverage;
};

}  // namespace hydro::torture
