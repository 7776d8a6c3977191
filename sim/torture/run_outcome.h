// The input of a run, and its outcome.
#pragma once

#include <cstdint>
#include <vector>

#include "settings/stack_config.h"
#include "sim/torture/invariants/observer.h"

namespace hydro::torture {

// The stacks that are run.
struct Stacks {
  settings::StackConfig right;
  settings::StackConfig other;          // started by FaultKind::kOtherConfiguration
  settings::StackConfig other_version;  // started by kOtherVersion
  settings::StackConfig knee;           // the other joint of a limb
  settings::StackConfig whole;          // what an operator addresses: all joints of a limb
};

struct RunOutcome {
  std::vector<Violation> violations;
  uint64_t trace = 0;  // of everything that happened
  Coverage coverage;
};

}  // namespace hydro::torture
