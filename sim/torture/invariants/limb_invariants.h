// The invariant of a limb: no joint is driven while another joint, from which it has heard, has a fault or is
// silent.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "settings/stack_config.h"
#include "sim/torture/invariants/coverage.h"
#include "sim/torture/machines/network.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

class LimbInvariants {
 public:
  // `config` belongs to the joint that is checked. That joint has one sibling.
  LimbInvariants(const settings::StackConfig& config, Network& network, const TrueTime* now);

  // A process of the sibling sends.
  void OnSent(const Packet& packet, Coverage* coverage);
  // A packet is passed to the handlers of this joint's plant.
  void OnHandled(const Packet& packet, const SimulatedProcess& plant);
  // This joint's plant puts out a voltage. Returns what is wrong with it; empty: nothing.
  std::string OnDrive(const SimulatedProcess& plant, int64_t tick, double voltage);

  // The last time at which the sibling was driven, according to its states; -1: never.
  TrueTime sibling_driven() const { return sibling_driven_; }

 private:
  // What one plant process of this joint knows of the sibling.
  struct Heard {
    int64_t tick = 0;                            // of the last voltage that the process put out
    std::optional<bus::Clock::TimePoint> state;  // when it was passed the sibling's newest state
    std::set<int64_t> left;                      // sessions that have announced their end
    std::string fault;               // code of an active fault, according to the newest message on faults
    int64_t fault_tick = 0;          // tick at which it began
    bus::Clock::TimePoint fault_at;  // time at which it began
  };

  const double silence_s_;
  const TrueTime* now_;
  const int state_, fault_, active_faults_, status_;  // channels of the sibling
  std::map<int, Heard> heard_;                        // by number of the plant process
  TrueTime sibling_driven_ = -1;
};

}  // namespace hydro::torture
