// Whether another joint of the same limb, in another process, has a fault that zeroes its voltage, or is no longer heard.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "process/fault_codes.h"
#include "process/participant.h"
#include "process/remote_faults.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class SiblingFaults {
 public:
  // Subscribes to the siblings' faults on the participant's bus, and to the states of those whose silence matters; must outlive it.
  SiblingFaults(process::Participant& participant, const std::vector<settings::Sibling>& siblings);

  bool empty() const { return siblings_.empty(); }

  // "joint knee has the fault pressure_limit (plant)"; empty when none has one. Both are cheap when all is well.
  std::string Fault(bus::Clock::TimePoint now);
  // "joint knee has not been heard for 0.2 s, ..."; empty when each is heard, has not been yet, or has said that it leaves.
  std::string Silence(bus::Clock::TimePoint now) const;

 private:
  struct Heard {
    settings::Sibling sibling;
    // That the others are at zero volts because one has a fault is no fault of theirs: they would hold each other for ever.
    process::RemoteFaults faults{[](std::string_view, std::string_view code) {
      return process::LeadsToZeroVolts(code) && code != "other_joint";
    }};
    std::optional<bus::Clock::TimePoint> state_at = {};  // when the newest came, of a plant that has not left
    int64_t session = 0;                                 // that plant's
    std::optional<int64_t> left =
        {};  // the session of one that has: states of it that come later are no sign of life
  };

  void OnStatus(const process_status_t& status, Heard& heard);

  process::Participant& participant_;
  std::vector<std::unique_ptr<Heard>> siblings_;
};

}  // namespace hydro::plant
