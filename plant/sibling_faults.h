// Whether another joint of the same limb, in whatever process, has a fault that zeroes its voltage.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "process/fault_codes.h"
#include "process/participant.h"
#include "process/remote_faults.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class SiblingFaults {
 public:
  // Subscribes to the siblings' faults on the participant's bus; must outlive it.
  SiblingFaults(process::Participant& participant, const std::vector<settings::Sibling>& siblings);

  bool empty() const { return siblings_.empty(); }

  // "joint knee: plant: pressure_limit"; empty when none has one. Cheap when none has.
  std::string Text();

 private:
  struct Heard {
    std::string joint;
    // That the others are at zero volts because one has a fault is no fault of theirs: they would hold each other for ever.
    process::RemoteFaults faults{[](std::string_view, std::string_view code) {
      return process::LeadsToZeroVolts(code) && code != "other_joint";
    }};
  };

  process::Participant& participant_;
  std::vector<std::unique_ptr<Heard>> siblings_;
};

}  // namespace hydro::plant
