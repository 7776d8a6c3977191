// What must hold of a launch, whose logic is the launcher's own: computed from what its children did, and what it was sent.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "settings/stack_config.h"
#include "sim/torture/invariants/observer.h"
#include "sim/torture/machines/network.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

// Its role, as texts say it.
std::string NameOf(const SimulatedProcess& process);

class LaunchInvariants {
 public:
  LaunchInvariants(const settings::StackConfig& config, Network& network, const TrueTime* now,
                   Observer& observer);

  // A launcher begins; there is one at a time.
  void OnBegin(const SimulatedProcess& launcher);
  // It starts a child; it sends one a signal.
  void OnStart(const SimulatedProcess& child);
  void OnSignal(const SimulatedProcess& child, int signal);
  // It is sent SIGINT.
  void OnInterrupt();
  // It stands still until then.
  void OnFrozen(TrueTime until);
  void OnSent(const Packet& packet);
  void OnHandled(const Packet& packet, const SimulatedProcess& launcher);
  // A process has ended: it, a child of it, or another.
  void OnEnd(const SimulatedProcess& process);

  // The launcher that runs; -1: none. Its children, alive or not.
  int launcher() const { return launch_ ? launch_->launcher : -1; }
  std::vector<const SimulatedProcess*> children() const;
  // When it must have ended; nothing: it has no reason to end.
  std::optional<TrueTime> due() const;
  void ReportOverdue();

 private:
  // Of a flood of made-up faults it keeps no more (launch/logic/run_summary.cc).
  static constexpr size_t kMostFaults = 200;

  struct Launch {
    int launcher = -1;
    TrueTime started = 0;  // its first child
    std::vector<const SimulatedProcess*> children;
    std::optional<TrueTime> cause;  // since when it has a reason to end
    std::string why;
    TrueTime frozen_until = 0;
    TrueTime frozen = 0;  // for how long it has stood still since
    bool stop_heard = false;
    bool stop_sent = false;
    bool others = false;    // it has heard of a process with one of its roles before it started any
    bool confused = false;  // a status that it heard was changed on the way
    int interrupts = 0;
    std::optional<TrueTime> second_interrupt;
    std::map<const SimulatedProcess*, TrueTime> told;  // children, since when: SIGTERM
    std::optional<TrueTime> early_end;  // a child has ended with 0, and it has heard of no stop since
    std::string failed;                 // what makes its exit code 1; empty: nothing
    std::string may_fail;               // what may do so
    std::map<int, TrueTime> ready;      // by child, when it heard that first
    std::map<std::pair<int64_t, std::string>, bool> faults;  // by sender and code, as it heard: active
  };

  bool Owns(const SimulatedProcess& process) const;
  void Cause(const std::string& why);
  void OnChildEnd(const SimulatedProcess& child);
  void OnStop(const Packet& packet, const SimulatedProcess& launcher);
  void OnStatus(const Packet& packet);
  void OnLauncherEnd(const SimulatedProcess& launcher);
  std::string WhatFailed() const;
  std::string WhatMayHaveFailed() const;

  const settings::StackConfig& config_;
  const TrueTime* now_;
  Observer& observer_;
  const int stop_, fault_, status_;  // channel numbers
  std::optional<Launch> launch_;
};

}  // namespace hydro::torture
