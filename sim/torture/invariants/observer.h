// Watches a run from outside: records what really happened and checks it against the invariants. It knows
// what was injected and what went over the wire, and asks no process for its view.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "model/terms/measurement.h"
#include "settings/stack_config.h"
#include "sim/torture/invariants/coverage.h"
#include "sim/torture/invariants/limb_invariants.h"
#include "sim/torture/invariants/records.h"
#include "sim/torture/machines/network.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

// An invariant that does not hold.
struct Violation {
  std::string invariant;  // docs/developers/torture.md describes each
  std::string text;       // one line: what was found, what is allowed
  TrueTime at = 0;
};

class Observer {
 public:
  Observer(const settings::StackConfig& config, Network& network, const TrueTime* now, Coverage& coverage);

  // The process with that session runs with another configuration than the rest of the stack.
  void AddMisconfigured(int64_t session) { misconfigured_.insert(session); }
  // Every message is sealed.
  void SetSealed() { sealed_ = true; }
  // A process sends.
  void OnSent(const Packet& packet, const SimulatedProcess& sender);
  // A packet is passed to the handlers of a process.
  void OnHandled(const Packet& packet, const SimulatedProcess& receiver);
  // The plant's sensors give `measured` for `tick`.
  void OnRead(const SimulatedProcess& plant, int64_t tick, const model::Measurement& measured,
              int64_t suspended_ns);
  // The plant puts out a voltage from `tick` on.
  void OnDrive(const SimulatedProcess& plant, int64_t tick, double voltage);
  // A process is sent a signal that it catches; a heartbeat of its launcher reaches a plant.
  void OnSignal(const SimulatedProcess& process) {
    if (process.role() == Role::kPlant) RecordOf(process).Stop();
  }
  void OnHeartbeat(const SimulatedProcess& plant) { RecordOf(plant).heartbeat = plant.machine().Now(); }
  // The board of a driver refuses the zero at the driver's end.
  void OnZeroRefused(const SimulatedProcess& driver) { RecordOf(driver).zero_refused = true; }
  // From now on, processes with another configuration than the plant's take part, or no longer do.
  void SetOtherConfiguration(bool present);
  // A process has ended.
  void OnEnd(const SimulatedProcess& process);

  void Report(const std::string& invariant, const std::string& text);
  const std::vector<Violation>& violations() const { return violations_; }

  // The last time at which a plant obeyed a command; -1: never.
  TrueTime last_obeyed() const { return last_obeyed_; }
  PlantRecord* newest_plant() { return newest_plant_; }
  // The last time at which a reference differed from the one before; -1: never.
  TrueTime reference_moved() const { return reference_moved_; }
  // The last time at which the other joint of a limb was driven; none: there is no other joint.
  std::optional<TrueTime> sibling_driven() const {
    return limb_ ? std::optional(limb_->sibling_driven()) : std::nullopt;
  }

 private:
  friend class PlantInvariants;
  PlantRecord& RecordOf(const SimulatedProcess& plant);
  void OnState(const Packet& packet, const SimulatedProcess& sender);
  void OnFault(const Packet& packet);
  void OnSettings(const Packet& packet, PlantRecord& plant);
  void OnStatistics(const Packet& packet, const SimulatedProcess& sender);
  bool OnStop(const Packet& packet, const SimulatedProcess& process);
  void CheckLeft(const PlantRecord& plant);
  void OnPressureCommand(const Packet& packet, const SimulatedProcess& sender);
  void OnReference(const Packet& packet, const SimulatedProcess& sender);
  void OnChangedState(const Packet& packet);
  void OnCommand(const Packet& packet, PlantRecord& plant);

  const settings::StackConfig& config_;
  Network& network_;
  const TrueTime* now_;
  Coverage& coverage_;
  const int state_, command_, fault_, stop_, rearm_, configuration_, run_, statistics_, output_left_,
      pressure_command_, reference_, settings_;       // channel numbers
  std::vector<std::unique_ptr<PlantRecord>> plants_;  // by number of the process
  PlantRecord* newest_plant_ = nullptr;
  std::vector<Violation> violations_;
  std::set<int64_t> misconfigured_;  // sessions
  bool sealed_ = false;
  TrueTime last_obeyed_ = -1;
  TrueTime reference_moved_ = -1;
  double reference_value_ = 0;                                  // of the newest reference
  static constexpr TrueTime kChangedForgotten = 2'000'000'000;  // ns after which the reference has returned
  TrueTime changed_state_ = -kChangedForgotten;  // the last time at which a state with wrong bits was handled
  TrueTime other_configuration_ = -1;            // the time since which it takes part
  std::optional<LimbInvariants> limb_;
  std::map<int, LossCount> losses_;     // for position loops, by number of the process
  std::set<int> in_a_run_;              // processes that have heard of a plant
  std::map<int, std::set<int>> stops_;  // exit codes of the genuine stops that each process heard or sent
};

}  // namespace hydro::torture
