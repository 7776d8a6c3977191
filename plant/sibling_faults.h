// Watches the other joints of the same limb, which run in other processes. It reports whether they are
// present and which of their faults matter here. Where a fault of one joint concerns all, these are a fault
// that zeroes its voltage, its silence, and its end.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/process_status_t.hpp>
#include <hydro/stop_t.hpp>
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

// Split what a run waits for (--expect) into the joints, written "joint:NAME", and the roles of this joint's
// own processes.
std::vector<std::string> ExpectedJoints(const std::vector<std::string>& expected);
std::vector<std::string> ExpectedRoles(const std::vector<std::string>& expected);

class SiblingFaults {
 public:
  struct Options {
    bool follows = true;     // whether faults of other joints concern this process
    int64_t last_tick = -1;  // of the run; -1: none. A sibling that ends there ends in order
    std::function<void()> on_newcomer =
        {};  // a sibling's plant is about to begin: it may not know our faults
  };
  // Subscribes on the participant's bus; `participant` must outlive this object.
  SiblingFaults(process::Participant& participant, const std::vector<settings::Sibling>& siblings,
                Options options);

  bool follows() const { return options_.follows && !siblings_.empty(); }

  // Those of these joints whose plants have not announced themselves, as "joint knee".
  std::vector<std::string> Missing(const std::vector<std::string>& joints) const;

  // "joint knee has the fault pressure_limit (plant)"; empty when no joint has a fault. Both this function
  // and Silence() are cheap when all is well.
  std::string Fault(bus::Clock::TimePoint now);
  // "joint knee has not been heard for 0.2 s, ..."; empty when each joint is heard, has not been heard yet,
  // or has said that it leaves.
  std::string Silence(bus::Clock::TimePoint now) const;
  // The first stop or failure of another joint before the run was over, with that joint's name; it ends this
  // run too.
  const std::optional<stop_t>& stop() const { return stop_; }

 private:
  struct Heard {
    settings::Sibling sibling;
    // "other_joint" does not count as a fault here. Joints that stand at zero volts because one joint has a
    // fault would otherwise hold each other at zero for ever.
    process::RemoteFaults faults{[](std::string_view, std::string_view code) {
      return process::LeadsToZeroVolts(code) && code != "other_joint";
    }};
    // The arrival of its newest state, while its plant has not left.
    std::optional<bus::Clock::TimePoint> state_at = {};
    std::optional<int64_t> plant = {};  // the session of its plant
    std::optional<int64_t> left =
        {};  // of one that has left: states of it that come later are no sign of life
  };

  void Follow(Heard& heard, const bus::Channels& channels);
  void OnStatus(const process_status_t& status, Heard& heard);
  void OnState(const state_t& state, Heard& heard);
  void OnStop(const stop_t& stop, const Heard& heard);
  void End(const Heard& heard, const std::string& reason, int exit_code);

  process::Participant& participant_;
  const Options options_;
  std::vector<std::unique_ptr<Heard>> siblings_;
  std::optional<stop_t> stop_;
};

}  // namespace hydro::plant
